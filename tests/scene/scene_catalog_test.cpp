#include "scene/scene_catalog.h"

#include <gtest/gtest.h>

#include <fstream>
#include <numbers>

#include "tests/scene/test_worlds.h"

namespace nextview {
namespace {

namespace fs = std::filesystem;

// A folder of its own for a test, removed with it.
class SceneCatalog : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(::testing::TempDir()) /
              (std::string("nextview_") +
               ::testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  void write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name) << text;
  }

  std::string failure(const std::string& argument) {
    try {
      find_scene(argument, kScenesFolder);
    } catch (const SceneError& error) {
      return error.what();
    }
    return "no SceneError";
  }

  fs::path folder_;
};

TEST_F(SceneCatalog, KnowsOurScenesInAlphabeticalOrder) {
  EXPECT_EQ(known_scenes(kScenesFolder), (std::vector<std::string>{"boxes", "columns"}));
  EXPECT_TRUE(known_scenes(folder_ / "absent").empty());
}

TEST_F(SceneCatalog, AName) {
  const SceneDescription scene = find_scene("boxes", kScenesFolder);
  EXPECT_EQ(scene.name, "boxes");
  EXPECT_EQ(scene.file, kScenesFolder / "boxes/boxes.obj");
  EXPECT_EQ(scene.options.unit_m, 1.0);
  EXPECT_EQ(scene.options.up, UpAxis::Z);
  ASSERT_TRUE(scene.start_m.has_value());
  EXPECT_EQ(*scene.start_m, Eigen::Vector3d(0.7, 1.0, 1.2));
  EXPECT_NEAR(scene.start_pan_rad.value(), -std::numbers::pi / 2.0, 1e-12);
  EXPECT_EQ(scene.surface_area_m2, 89.0);
}

TEST_F(SceneCatalog, AFileAloneSaysNothing) {
  const SceneDescription scene = find_scene((kDataFolder / "triangle.ply").string(), kScenesFolder);
  EXPECT_EQ(scene.name, "triangle");
  EXPECT_FALSE(scene.options.unit_m.has_value());
  EXPECT_FALSE(scene.options.up.has_value());
  EXPECT_FALSE(scene.start_m.has_value());
}

TEST_F(SceneCatalog, AFileBesideASceneJsonThatNamesIt) {
  write("flat.ply", "ply");
  write("other.ply", "ply");
  write("scene.json",
        R"({"name": "my flat", "file": "flat.ply", "unit": "cm", "up": "y", "start": [1, 2, 3]})");
  const SceneDescription flat = find_scene((folder_ / "flat.ply").string(), kScenesFolder);
  EXPECT_EQ(flat.name, "my flat");
  EXPECT_EQ(flat.options.unit_m, 0.01);
  EXPECT_EQ(flat.options.up, UpAxis::Y);
  EXPECT_EQ(flat.start_m.value(), Eigen::Vector3d(1, 2, 3));
  EXPECT_FALSE(flat.start_pan_rad.has_value());
  EXPECT_EQ(find_scene(folder_.string(), kScenesFolder).file, flat.file);

  const SceneDescription other = find_scene((folder_ / "other.ply").string(), kScenesFolder);
  EXPECT_EQ(other.name, "other");
  EXPECT_FALSE(other.start_m.has_value());
}

TEST_F(SceneCatalog, WhatIsGivenWins) {
  const SceneDescription scene =
      find_scene("boxes", kScenesFolder, {.unit_m = 0.01, .up = UpAxis::Y});
  EXPECT_EQ(scene.options.unit_m, 0.01);
  EXPECT_EQ(scene.options.up, UpAxis::Y);
}

TEST_F(SceneCatalog, AnUnknownNameListsTheKnownOnes) {
  const std::string message = failure("boxs");
  EXPECT_NE(message.find("boxs: no such file, and no scene of that name"), std::string::npos);
  EXPECT_NE(message.find("boxes, columns"), std::string::npos);
  EXPECT_NE(failure("").find("no such file"), std::string::npos);
}

TEST_F(SceneCatalog, AMalformedSceneJsonIsNamedWithWhatIsWrong) {
  const auto failure_of = [&](const std::string& json) {
    write("scene.json", json);
    const std::string message = failure(folder_.string());
    EXPECT_NE(message.find("scene.json: "), std::string::npos) << message;
    return message;
  };
  EXPECT_NE(failure_of("{").find("parse error"), std::string::npos);
  EXPECT_NE(failure_of("[]").find("must be a JSON object"), std::string::npos);
  EXPECT_NE(failure_of("{}").find("lacks \"file\""), std::string::npos);
  EXPECT_NE(failure_of(R"({"file": "a", "up": "w"})").find("up axis 'w'"), std::string::npos);
  EXPECT_NE(failure_of(R"({"file": "a", "unit": "ell"})").find("unit 'ell'"), std::string::npos);
  EXPECT_NE(failure_of(R"({"file": "a", "unit": -1})").find("unit '-1'"), std::string::npos);
  EXPECT_NE(failure_of(R"({"file": "a", "start": [1, 2]})").find("\"start\""), std::string::npos);
  EXPECT_NE(failure_of(R"({"file": "a", "start": [1, 2, 3, 4]})").find("\"start\""),
            std::string::npos);
}

}  // namespace
}  // namespace nextview

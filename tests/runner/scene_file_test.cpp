#include "runner/scene_file.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "runner/run_options.h"

namespace nextview {
namespace {

namespace fs = std::filesystem;

class SceneFileTest : public testing::Test {
 protected:
  SceneFileTest()
      : folder_(fs::path(testing::TempDir()) /
                (std::string("nextview-scene-file-") +
                 testing::UnitTest::GetInstance()->current_test_info()->name())) {
    fs::create_directories(folder_);
  }
  ~SceneFileTest() override { fs::remove_all(folder_); }

  std::string write(const std::string& text) {
    const fs::path file = folder_ / "flat.toml";
    std::ofstream(file) << text;
    return file.string();
  }
  std::optional<RunOptions> parse(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "nextview_run");
    std::vector<char*> argv;
    for (std::string& argument : arguments) argv.push_back(argument.data());
    testing::internal::CaptureStderr();
    auto options = parse_run_options(static_cast<int>(argv.size()), argv.data(), status_, "");
    error_ = testing::internal::GetCapturedStderr();
    return options;
  }

  fs::path folder_;
  int status_ = 0;
  std::string error_;
};

TEST_F(SceneFileTest, HoldsWhatWouldBeTyped) {
  const auto options = parse({write(R"(
model = "rooms/flat.dae"
unit = "cm"
start = [1, 2.5, 1.2]
[sensor]
columns = 128
range-max = 12.5
[limits]
lift-max = 2.0
quality = true
)")});
  ASSERT_TRUE(options) << error_;
  EXPECT_EQ(*options->scene, (folder_ / "rooms/flat.dae").string());
  EXPECT_EQ(options->unit, "cm");
  EXPECT_EQ(options->start_m, (std::vector<double>{1.0, 2.5, 1.2}));
  EXPECT_EQ(options->given_of_sensor.columns, 128);
  EXPECT_EQ(options->given_of_sensor.range_max_m, 12.5);
  EXPECT_EQ(options->lift_max_m, 2.0);
  EXPECT_TRUE(options->quality);
}

TEST_F(SceneFileTest, GivesWayToTheCommandLine) {
  const std::string file = write("model = \"/flat.dae\"\nstart = \"auto\"\nseed = 3\n");
  auto options = parse({file});
  ASSERT_TRUE(options) << error_;
  EXPECT_EQ(*options->scene, "/flat.dae");
  EXPECT_TRUE(options->start_auto);
  EXPECT_EQ(options->seed, 3);
  options = parse({file, "--seed", "7", "--start", "1", "2", "3"});
  ASSERT_TRUE(options) << error_;
  EXPECT_EQ(options->seed, 7);
  EXPECT_FALSE(options->start_auto);
  EXPECT_EQ(options->start_m.size(), 3U);
}

TEST_F(SceneFileTest, NamesWhatCannotBe) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"model = \"a.obj\"\nclearence = 0.3\n",
       "flat.toml:2: no option 'clearence'; did you mean 'clearance'?"},
      {"modle = \"a.obj\"\n", "flat.toml:1: no option 'modle'; did you mean 'model'?"},
      {"seed = 1\n", "flat.toml: lacks model"},
      {"model = 7\n", "flat.toml:1: model must be a file's name"},
      {"model = \"a.obj\"\nclearance = 70\n", "flat.toml:2: --clearance"},
      {"model = \"a.obj\"\nstart = [1, 2]\n", "flat.toml:2: --start"},
      {"model = \"a.obj\"\nseed = 1979-05-27\n", "flat.toml:2: seed must be"},
      {"model = \"a.obj\n", "flat.toml:1: "},
  };
  for (const auto& [text, words] : cases) {
    EXPECT_FALSE(parse({write(text)})) << text;
    EXPECT_EQ(status_, 1);
    EXPECT_NE(error_.find(words), std::string::npos) << error_;
  }
  EXPECT_FALSE(parse({(folder_ / "none.toml").string()}));
  EXPECT_NE(error_.find("none.toml"), std::string::npos) << error_;
}

}  // namespace
}  // namespace nextview

#include "scene/scene_catalog.h"

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>

namespace nextview {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

// What one scene.json says; the keys are those of scenes/boxes/scene.json.
class SceneJson {
 public:
  explicit SceneJson(const fs::path& path) : path_(path) {
    std::ifstream stream(path);
    try {
      json_ = json::parse(stream);
    } catch (const json::exception& error) {
      fail(error.what());
    }
    if (!json_.is_object()) {
      fail("must be a JSON object");
    }
  }

  fs::path file() const {
    const auto name = get<std::string>("file");
    if (!name) fail("lacks \"file\", the name of the CAD file");
    return path_.parent_path() / *name;
  }

  SceneDescription description() const {
    SceneDescription scene;
    scene.file = file();
    scene.name = get<std::string>("name").value_or(scene.file.stem().string());
    try {
      if (const auto up = get<std::string>("up")) scene.options.up = parse_up_axis(*up);
      if (json_.contains("unit")) {
        scene.options.unit_m = json_["unit"].is_number() ? parse_unit_m(json_["unit"].dump())
                                                         : parse_unit_m(*get<std::string>("unit"));
      }
    } catch (const std::invalid_argument& error) {
      fail(error.what());
    }
    if (const auto start = get<std::vector<double>>("start")) {
      if (start->size() != 3) fail("\"start\": must be [x, y, z] in metres");
      scene.start_m = Eigen::Vector3d((*start)[0], (*start)[1], (*start)[2]);
    }
    if (const auto pan_deg = get<double>("start_pan_deg")) {
      scene.start_pan_rad = *pan_deg * std::numbers::pi / 180.0;
    }
    scene.surface_area_m2 = get<double>("surface_area_m2");
    scene.triangles = get<std::int64_t>("triangles");
    return scene;
  }

 private:
  template <class Value>
  std::optional<Value> get(const char* key) const {
    if (!json_.contains(key)) return std::nullopt;
    try {
      return json_[key].get<Value>();
    } catch (const json::exception& error) {
      fail(std::string("\"") + key + "\": " + error.what());
    }
  }

  [[noreturn]] void fail(const std::string& why) const {
    throw SceneError(path_.string() + ": " + why);
  }

  fs::path path_;
  json json_;
};

SceneDescription describe_file(const fs::path& file) {
  const fs::path beside = (file.has_parent_path() ? file.parent_path() : ".") / "scene.json";
  if (fs::exists(beside)) {
    const SceneJson scene_json(beside);
    if (scene_json.file().filename() == file.filename()) {
      return scene_json.description();
    }
  }
  SceneDescription scene;
  scene.name = file.stem().string();
  scene.file = file;
  return scene;
}

SceneDescription describe(const std::string& argument, const fs::path& scenes_folder) {
  const std::vector<std::string> known = known_scenes(scenes_folder);
  if (std::find(known.begin(), known.end(), argument) != known.end()) {
    return SceneJson(scenes_folder / argument / "scene.json").description();
  }
  if (fs::is_regular_file(argument)) {
    return describe_file(argument);
  }
  if (fs::exists(fs::path(argument) / "scene.json")) {
    return SceneJson(fs::path(argument) / "scene.json").description();
  }
  std::string names;
  for (const std::string& name : known) {
    names += (names.empty() ? "" : ", ") + name;
  }
  throw SceneError(argument + ": no such file, and no scene of that name; the scenes in " +
                   scenes_folder.string() + " are: " + (names.empty() ? "none" : names));
}

}  // namespace

std::vector<std::string> known_scenes(const fs::path& scenes_folder) {
  std::vector<std::string> names;
  if (fs::is_directory(scenes_folder)) {
    for (const fs::directory_entry& entry : fs::directory_iterator(scenes_folder)) {
      if (fs::exists(entry.path() / "scene.json")) {
        names.push_back(entry.path().filename().string());
      }
    }
  }
  std::sort(names.begin(), names.end());
  return names;
}

SceneDescription find_scene(const std::string& argument, const fs::path& scenes_folder,
                            const SceneOptions& given) {
  SceneDescription scene = describe(argument, scenes_folder);
  if (given.unit_m) scene.options.unit_m = given.unit_m;
  if (given.up) scene.options.up = given.up;
  return scene;
}

}  // namespace nextview

// Holds the arrows of the design: sensor geometry <- voxel map <- view planning; ground truth for
// the simulators and the scoring only; libraries know no bus.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace nextview {
namespace {

namespace fs = std::filesystem;

enum class Part {
  SensorGeometry,
  Scene,
  Base,
  VoxelMap,
  ViewPlanning,
  Bus,        // lcmtypes
  SensorBus,  // how a range image travels: for everybody
  SceneBus,   // the simulators' processes
  MapperBus,
  PlannerBus,
  Scoring,
  RunLog,
  Run,
};

const std::set<std::string> kSensorGeometry = {"random_stream", "range_image", "sensor_geometry",
                                               "sensor_pose", "vector_clones"};
const std::set<std::string> kSensorBus = {"range_image_message", "sensor_config"};
const std::set<std::string> kScoring = {"position_tree", "reachable_positions", "surface_samples",
                                        "surface_shadow", "visible_surface"};
const std::set<std::string> kRunLog = {"log_reader", "replay", "replay_main", "run_log",
                                       "run_record"};

/// Files of a role's folder that belong to its process and not to its library.
bool is_of_process(const std::string& stem) {
  for (const char* ending : {"_process", "_main", "_config", "_message"}) {
    if (stem.ends_with(ending)) return true;
  }
  return false;
}

Part part_of(const fs::path& file) {  // relative to the repository
  const std::string folder = file.begin()->string();
  const std::string stem = file.stem().string();
  if (folder == "lcmtypes") return Part::Bus;
  if (folder == "sensor_sim") {
    if (kSensorGeometry.contains(stem)) return Part::SensorGeometry;
    if (kSensorBus.contains(stem)) return Part::SensorBus;
    return is_of_process(stem) ? Part::SceneBus : Part::Scene;
  }
  if (folder == "base_sim") return is_of_process(stem) ? Part::SceneBus : Part::Base;
  if (folder == "mapper") return is_of_process(stem) ? Part::MapperBus : Part::VoxelMap;
  if (folder == "planner") return is_of_process(stem) ? Part::PlannerBus : Part::ViewPlanning;
  if (folder == "logger") {
    if (kScoring.contains(stem)) return Part::Scoring;
    return kRunLog.contains(stem) ? Part::RunLog : Part::Run;
  }
  throw std::invalid_argument(file.string() + " belongs to no part of the design");
}

const std::map<Part, std::set<Part>> kMayInclude = {
    {Part::SensorGeometry, {}},
    {Part::Scene, {Part::SensorGeometry}},
    {Part::Base, {Part::SensorGeometry, Part::Scene}},
    {Part::VoxelMap, {Part::SensorGeometry}},
    {Part::ViewPlanning, {Part::SensorGeometry, Part::VoxelMap}},
    {Part::Bus, {}},
    {Part::SensorBus, {Part::SensorGeometry, Part::Bus}},
    {Part::SceneBus, {Part::SensorGeometry, Part::Scene, Part::Base, Part::Bus, Part::SensorBus}},
    {Part::MapperBus, {Part::SensorGeometry, Part::VoxelMap, Part::Bus, Part::SensorBus}},
    {Part::PlannerBus,
     {Part::SensorGeometry, Part::VoxelMap, Part::ViewPlanning, Part::Bus, Part::SensorBus,
      Part::MapperBus}},
    {Part::Scoring, {Part::SensorGeometry, Part::Scene}},
    {Part::RunLog,
     {Part::SensorGeometry, Part::VoxelMap, Part::ViewPlanning, Part::Bus, Part::SensorBus,
      Part::MapperBus, Part::PlannerBus}},
    {Part::Run,
     {Part::SensorGeometry, Part::Scene, Part::Base, Part::VoxelMap, Part::ViewPlanning, Part::Bus,
      Part::SensorBus, Part::SceneBus, Part::MapperBus, Part::PlannerBus, Part::Scoring,
      Part::RunLog}},
};

/// Parts that must not see LCM's generated headers, nor LCM itself.
const std::set<Part> kLibraries = {Part::SensorGeometry, Part::Scene,        Part::Base,
                                   Part::VoxelMap,       Part::ViewPlanning, Part::Scoring};

std::vector<fs::path> sources() {
  std::vector<fs::path> files;
  const fs::path root = NEXTVIEW_SOURCE_DIR;
  for (const char* folder : {"lcmtypes", "sensor_sim", "base_sim", "mapper", "planner", "logger"}) {
    for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
      const std::string extension = entry.path().extension().string();
      if (extension == ".h" || extension == ".cpp") {
        files.push_back(fs::relative(entry.path(), root));
      }
    }
  }
  return files;
}

std::vector<std::string> includes_of(const fs::path& file) {
  static const std::regex kInclude(R"re(^\s*#\s*include\s*([<"][^>"]+)[>"])re");
  std::ifstream in(fs::path(NEXTVIEW_SOURCE_DIR) / file);
  std::vector<std::string> includes;
  std::smatch match;
  for (std::string line; std::getline(in, line);) {
    if (std::regex_search(line, match, kInclude)) includes.push_back(match[1]);
  }
  return includes;
}

TEST(IncludeArrows, RunOneWay) {
  int arrows = 0;
  for (const fs::path& file : sources()) {
    const Part part = part_of(file);
    for (const std::string& include : includes_of(file)) {
      if (include[0] != '"') continue;
      const Part included = part_of(include.substr(1));
      ++arrows;
      EXPECT_TRUE(included == part || kMayInclude.at(part).contains(included))
          << file << " must not include " << include.substr(1);
    }
  }
  EXPECT_GT(arrows, 200);
}

TEST(IncludeArrows, LeaveTheBusOutOfLibraries) {
  int libraries = 0;
  for (const fs::path& file : sources()) {
    if (!kLibraries.contains(part_of(file))) continue;
    ++libraries;
    for (const std::string& include : includes_of(file)) {
      EXPECT_FALSE(include.starts_with("<lcm/") || include.starts_with("<nextview/"))
          << file << " must not include " << include.substr(1);
    }
  }
  EXPECT_GT(libraries, 40);
}

TEST(IncludeArrows, HideEmbreeAndAssimp) {
  std::map<std::string, std::set<std::string>> users;
  for (const fs::path& file : sources()) {
    for (const std::string& include : includes_of(file)) {
      for (const char* library : {"embree", "assimp"}) {
        if (include.find(library) != std::string::npos) users[library].insert(file.string());
      }
    }
  }
  EXPECT_EQ(users["embree"], std::set<std::string>{"sensor_sim/scene.cpp"});
  EXPECT_EQ(users["assimp"], std::set<std::string>{"sensor_sim/mesh_file.cpp"});
}

TEST(IncludeArrows, LeaveClocksAndGeneratorsOutOfLibraries) {
  static const std::regex kForbidden(
      R"(std::(random_device|rand\b|time\b|(uniform|normal)_\w+_distribution)|_clock::now|\brand\(\))");
  for (const fs::path& file : sources()) {
    if (!kLibraries.contains(part_of(file))) continue;
    std::ifstream in(fs::path(NEXTVIEW_SOURCE_DIR) / file);
    int number = 0;
    for (std::string line; std::getline(in, line);) {
      ++number;
      EXPECT_FALSE(std::regex_search(line, kForbidden)) << file << ":" << number << ": " << line;
    }
  }
}

}  // namespace
}  // namespace nextview

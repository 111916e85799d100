// Holds the arrows of the design: sensor <- voxel map <- view planning; ground truth for the
// simulators, the scoring and those who start them only; libraries know no bus.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace nextview {
namespace {

namespace fs = std::filesystem;

using Folders = std::set<std::string>;

/// Whether all files of a folder are on the bus, or those only whose names say so (see is_of_bus).
enum class OnTheBus { ByName, Whole };

/// What a folder may include besides itself. A folder's library and its files on the bus have their
/// own arrows; the bus files of a folder may include what its library may, the library itself, and
/// lcmtypes. This table is the one place that a new folder is told to.
struct Arrows {
  Folders every_file;
  Folders bus_file;
  OnTheBus on_the_bus = OnTheBus::ByName;
};
const std::map<std::string, Arrows> kArrows = {
    {"lcmtypes", {{}, {"sensor"}, OnTheBus::Whole}},
    {"sensor", {{}, {}}},
    {"scene", {{}, {}}},
    {"sensor_sim", {{"sensor", "scene"}, {}}},
    {"base_sim", {{"sensor", "scene"}, {}}},
    {"mapper", {{"sensor"}, {}}},
    {"planner/prediction", {{"sensor", "mapper"}, {}}},
    {"planner", {{"sensor", "mapper", "planner/prediction"}, {}}},
    {"logger", {{}, {"sensor", "mapper", "planner"}, OnTheBus::Whole}},
    {"scoring", {{"sensor", "scene", "sensor_sim", "mapper", "planner/prediction"}, {}}},
    {"reports", {{"sensor", "scene", "mapper", "planner"}, {"logger", "scoring"}, OnTheBus::Whole}},
    {"exporter", {{}, {"sensor", "mapper", "logger", "reports"}, OnTheBus::Whole}},
    {"viewer", {{}, {"sensor", "scene", "mapper", "logger"}, OnTheBus::Whole}},
    {"runner",
     {{},
      {"sensor", "scene", "sensor_sim", "base_sim", "mapper", "planner", "logger", "scoring",
       "reports", "viewer"},
      OnTheBus::Whole}},
};

/// Folders that hold no part of the system.
const Folders kNotOurs = {"tests", "bench", "examples"};

/// Without the bus, whatever their folder is, and for everybody: what a parameter may be and which
/// strategies there are is said once.
const std::set<fs::path> kForEverybody = {"lcmtypes/parameter_bounds.h",
                                          "planner/strategy_facts.h"};

bool is_of_bus(const std::string& folder, const std::string& stem) {
  if (kForEverybody.contains(fs::path(folder) / (stem + ".h"))) return false;
  const auto arrows = kArrows.find(folder);
  if (arrows != kArrows.end() && arrows->second.on_the_bus == OnTheBus::Whole) return true;
  for (const char* ending : {"_process", "_main", "_config", "_message"}) {
    if (stem.ends_with(ending)) return true;
  }
  return false;
}

struct Source {
  fs::path file;  // relative to the repository
  std::string folder;
  bool of_bus;
};

Source source_of(const fs::path& file) {
  const std::string folder = file.parent_path().string();
  return {file, folder, is_of_bus(folder, file.stem().string())};
}

bool may_include(const Source& from, const Source& to) {
  if (kForEverybody.contains(to.file)) return true;
  if (from.folder == to.folder) return from.of_bus || !to.of_bus;
  if (from.of_bus && to.folder == "lcmtypes") return true;
  if (to.of_bus && !from.of_bus) return false;
  const Arrows& arrows = kArrows.at(from.folder);
  return arrows.every_file.contains(to.folder) ||
         (from.of_bus && arrows.bus_file.contains(to.folder));
}

std::vector<Source> sources() {
  std::vector<Source> found;
  const fs::path root = NEXTVIEW_SOURCE_DIR;
  for (const auto& top : fs::directory_iterator(root)) {
    const std::string name = top.path().filename().string();
    if (!top.is_directory() || kNotOurs.contains(name) || name.starts_with("build") ||
        name.starts_with(".")) {
      continue;
    }
    for (const auto& entry : fs::recursive_directory_iterator(top.path())) {
      const std::string extension = entry.path().extension().string();
      if (extension == ".h" || extension == ".cpp") {
        found.push_back(source_of(fs::relative(entry.path(), root)));
      }
    }
  }
  return found;
}

std::string text_of(const fs::path& file) {
  std::ifstream in(fs::path(NEXTVIEW_SOURCE_DIR) / file);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::vector<std::string> includes_of(const Source& source) {
  static const std::regex kInclude(R"re(^\s*#\s*include\s*([<"][^>"]+)[>"])re");
  std::ifstream in(fs::path(NEXTVIEW_SOURCE_DIR) / source.file);
  std::vector<std::string> includes;
  std::smatch match;
  for (std::string line; std::getline(in, line);) {
    if (std::regex_search(line, match, kInclude)) includes.push_back(match[1]);
  }
  return includes;
}

TEST(IncludeArrows, KnowEveryFolder) {
  for (const Source& source : sources()) {
    EXPECT_TRUE(kArrows.contains(source.folder))
        << source.file << ": say in kArrows what " << source.folder << " may include";
  }
}

TEST(IncludeArrows, RunOneWay) {
  int arrows = 0;
  for (const Source& source : sources()) {
    for (const std::string& include : includes_of(source)) {
      if (include[0] != '"') continue;
      ++arrows;
      EXPECT_TRUE(may_include(source, source_of(include.substr(1))))
          << source.file << " must not include " << include.substr(1);
    }
  }
  EXPECT_GT(arrows, 300);
}

/// The law of ground truth, said once more without the table.
TEST(IncludeArrows, KeepGroundTruthFromMapperAndPlanner) {
  int looked_at = 0;
  for (const Source& source : sources()) {
    const std::string top = source.file.begin()->string();
    if (top != "mapper" && top != "planner") continue;
    for (const std::string& include : includes_of(source)) {
      ++looked_at;
      for (const char* folder : {"scene/", "sensor_sim/", "base_sim/", "scoring/", "runner/"}) {
        EXPECT_FALSE(include.substr(1).starts_with(folder))
            << source.file << " must not include " << include.substr(1);
      }
    }
  }
  EXPECT_GT(looked_at, 100);
}

TEST(IncludeArrows, LeaveTheBusOutOfLibraries) {
  int libraries = 0;
  for (const Source& source : sources()) {
    if (source.of_bus) continue;
    ++libraries;
    for (const std::string& include : includes_of(source)) {
      EXPECT_FALSE(include.starts_with("<lcm/") || include.starts_with("<nextview/"))
          << source.file << " must not include " << include.substr(1);
    }
  }
  EXPECT_GT(libraries, 80);
}

/// Which strategy a run has is nobody's business but its own and the list's: what differs between
/// strategies is a fact in the list.
TEST(IncludeArrows, KnowNoStrategyByName) {
  static const std::regex kAsked(R"(strategy\w*\s*[!=]=|[!=]=\s*\S*Strategy::kFacts)");
  for (const Source& source : sources()) {
    std::ifstream in(fs::path(NEXTVIEW_SOURCE_DIR) / source.file);
    int number = 0;
    for (std::string line; std::getline(in, line);) {
      ++number;
      // Whether there is one at all may be asked.
      line = std::regex_replace(line, std::regex(R"([!=]= nullptr)"), "");
      EXPECT_FALSE(std::regex_search(line, kAsked)) << source.file << ":" << number << ": " << line;
    }
  }
}

TEST(IncludeArrows, HideEmbreeAndAssimp) {
  std::map<std::string, std::set<std::string>> users;
  for (const Source& source : sources()) {
    for (const std::string& include : includes_of(source)) {
      for (const char* library : {"embree", "assimp"}) {
        if (include.find(library) != std::string::npos) {
          users[library].insert(source.file.string());
        }
      }
    }
  }
  EXPECT_EQ(users["embree"], std::set<std::string>{"scene/scene.cpp"});
  EXPECT_EQ(users["assimp"],
            (std::set<std::string>{"exporter/mesh_writer.cpp", "scene/cad_file.cpp"}));
}

/// A pattern that libfmt checks against its values, and one way to write a number.
TEST(IncludeArrows, WriteNumbersByLibfmt) {
  static const std::regex kByHand(R"(\bv?s?n?f?printf\(|setprecision|\bsetw\()");
  std::vector<fs::path> files;
  for (const Source& source : sources()) files.push_back(source.file);
  for (const auto& entry : fs::directory_iterator(fs::path(NEXTVIEW_SOURCE_DIR) / "bench")) {
    files.push_back(fs::path("bench") / entry.path().filename());
  }
  for (const fs::path& file : files) {
    const std::string text = text_of(file);
    std::smatch found;
    EXPECT_FALSE(std::regex_search(text, found, kByHand)) << file << ": " << found.str();
  }
}

/// The program that holds the versions for each instruction set against each other is compiled
/// from a list of its own.
TEST(IncludeArrows, KnowEverySourceWithVectorClones) {
  static const std::regex kClones(R"((^|\n)NEXTVIEW_VECTOR_CLONES\b)");
  std::set<std::string> cloned;
  for (const Source& source : sources()) {
    if (std::regex_search(text_of(source.file), kClones)) cloned.insert(source.file.string());
  }
  std::set<std::string> listed;
  std::istringstream list(NEXTVIEW_CLONED_SOURCES);
  for (std::string file; list >> file;) listed.insert(file);
  EXPECT_EQ(listed, cloned);
}

/// The C library's sines and exponentials differ in their last bit from processor to processor
/// (sensor/elementary_functions.h).
TEST(IncludeArrows, AskTheCLibraryForNoBitsOfMapsAndDecisions) {
  static const std::regex kAsked(
      R"(std::(a?(sin|cos|tan)h?|atan2|exp2?|expm1|log(2|10|1p)?|pow|hypot|cbrt)f?\()");
  // Where it is asked about what something is, and its last bits are not believed.
  const std::map<std::string, int> allowed = {
      {"planner/field_of_view.cpp", 2},
      {"planner/prediction/panorama_view_predictor.cpp", 1},
      {"sensor/elementary_functions.cpp", 1},
  };
  for (const Source& source : sources()) {
    const std::string top = source.file.begin()->string();
    if (top != "sensor" && top != "mapper" && top != "planner" && top != "logger") continue;
    const std::string text = text_of(source.file);
    const auto calls = std::distance(std::sregex_iterator(text.begin(), text.end(), kAsked), {});
    const auto found = allowed.find(source.file.string());
    EXPECT_EQ(calls, found == allowed.end() ? 0 : found->second) << source.file;
  }
}

TEST(IncludeArrows, LeaveClocksAndGeneratorsOutOfLibraries) {
  static const std::regex kForbidden(
      R"(std::(random_device|rand\b|time\b|(uniform|normal)_\w+_distribution)|_clock::now|\brand\(\))");
  for (const Source& source : sources()) {
    if (source.of_bus) continue;
    std::ifstream in(fs::path(NEXTVIEW_SOURCE_DIR) / source.file);
    int number = 0;
    for (std::string line; std::getline(in, line);) {
      ++number;
      EXPECT_FALSE(std::regex_search(line, kForbidden))
          << source.file << ":" << number << ": " << line;
    }
  }
}

}  // namespace
}  // namespace nextview

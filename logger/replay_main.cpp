#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>

#include "lcmtypes/program_version.h"
#include "logger/replay.h"

namespace {

/// The log of a run's folder, or the log itself.
std::filesystem::path log_of(const std::string& argument) {
  if (!std::filesystem::exists(argument)) {
    throw nextview::LogError(argument + ": no such folder");
  }
  if (!std::filesystem::is_directory(argument)) return argument;
  return std::filesystem::path(argument) / "run.lcmlog";
}

int replay_run(const std::string& argument, std::optional<std::int64_t> run,
               const nextview::ReplayOptions& options) {
  const std::filesystem::path file = log_of(argument);
  nextview::RunLog log(file, run, nextview::RangeImages::Keep);
  log.read_on();
  for (const std::string& line : log.dropped()) std::cerr << "left out: " << line << "\n";
  if (!run && !log.other_runs().empty()) {
    std::cerr << "the log holds other runs, too; name one by --run to replay it:";
    for (const std::int64_t other : log.other_runs()) std::cerr << " " << other;
    std::cerr << "\n";
  }
  const nextview::ReplayReport report = nextview::replay(log, options);
  if (!report.disagreement.empty()) {
    std::cerr << "nextview_replay: " << file.string() << ": " << report.disagreement;
    if (log.bytes_left() > 0) {
      std::cerr << " (the last " << log.bytes_left() << " bytes of the file are no whole message)";
    }
    std::cerr << std::endl;
    return 1;
  }
  std::cout << report.views << " views replayed, every map has the digest it had in the run";
  if (options.planner) {
    std::cout << "; " << report.goals << " goals decided again, every one the same";
  }
  std::cout << " (" << report.stop_reason << ")" << std::endl;
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{
      "Rebuilds a run's map from its log alone, with the mapper's own library, and compares the\n"
      "digest of every view with the one committed in the run. Reads no CAD file and needs no "
      "bus.\n"};
  std::string folder;
  std::optional<std::int64_t> run;
  nextview::ReplayOptions options;
  app.add_option("DIR", folder, "Folder of a run, or an LCM log")->required();
  app.add_flag("--planner", options.planner,
               "Decide every goal again, too, and compare pose, path, fitness and search exactly");
  app.add_option("--run", run, "The run to replay, when the log holds several");
  app.footer(
      "Exit status: 0 when all agrees; 1 otherwise, after one line that names the first view that\n"
      "differs or is missing, or what is wrong with the log.");
  app.set_version_flag("--version", "nextview_replay " + std::string(nextview::program_version()));
  CLI11_PARSE(app, argc, argv);
  try {
    return replay_run(folder, run, options);
  } catch (const std::exception& error) {
    std::cerr << "nextview_replay: " << error.what() << std::endl;
    return 1;
  }
}

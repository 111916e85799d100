#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <iostream>

#include "lcmtypes/program_version.h"
#include "lcmtypes/standard_output.h"
#include "logger/recovered_run.h"
#include "logger/replay.h"
#include "logger/unchecked_fields.h"

namespace {

constexpr std::size_t kLinesShown = 10;

void show(std::ostream& to, const std::string& what, const std::vector<std::string>& lines) {
  for (std::size_t i = 0; i < std::min(lines.size(), kLinesShown); ++i) {
    to << what << lines[i] << "\n";
  }
  if (lines.size() > kLinesShown) {
    to << what << "and " << lines.size() - kLinesShown << " more like these\n";
  }
}

void show_unchecked(const std::vector<nextview::UncheckedFields>& unchecked) {
  std::cout << "taken as it is:\n";
  for (const nextview::UncheckedFields& some : unchecked) {
    std::cout << "  " << some.channel << " (" << some.why << "):";
    for (const std::string& field : some.fields) {
      std::cout << " " << (field == "*" ? "all of it" : field);
    }
    std::cout << "\n";
  }
}

int replay_run(const std::string& argument, std::optional<std::int64_t> run,
               const nextview::ReplayOptions& options) {
  const std::filesystem::path file = nextview::log_file_of(argument);
  nextview::RunLog log(file, run, nextview::RangeImages::Keep);
  log.read_on();
  show(std::cerr, "left out: ", log.dropped());
  if (!run && !log.other_runs().empty()) {
    std::cerr << "the log holds other runs, too; name one by --run to replay it:";
    for (const std::int64_t other : log.other_runs()) std::cerr << " " << other;
    std::cerr << "\n";
  }
  const nextview::ReplayReport report = nextview::replay(log, options);
  show(std::cerr, "nextview_replay: " + file.string() + ": ", report.differences);
  show(std::cerr, "missing: ", report.missing);
  show(std::cout, "", report.remarks);
  const bool all = report.differences.empty();
  std::cout << report.views << " views replayed"
            << (all ? ", every map as it was in the run" : " to the map they had in the run");
  if (options.planner) {
    std::cout << "; " << report.goals << " goals decided again"
              << (all ? ", every one the same" : " to the same");
  }
  std::cout << " (" << (report.stop_reason.empty() ? "no end" : report.stop_reason) << ")\n";
  if (log.record().config()) {
    show_unchecked(nextview::unchecked_fields(log.record(), options.planner));
  }
  std::cout << std::flush;
  return report.exit_status();
}

}  // namespace

int main(int argc, char** argv) {
  nextview::answer_for_standard_output();
  CLI::App app{
      "Replays a run from its log alone: folds every range image again and holds against it all\n"
      "that the log says of maps, poses, paths, times and the run's end, bit for bit. Says what "
      "it\n"
      "cannot check. Reads no CAD file and needs no bus.\n"};
  std::string folder;
  std::optional<std::int64_t> run;
  nextview::ReplayOptions options;
  app.add_option("DIR", folder, "Folder of a run, or an LCM log")->required();
  app.add_flag("--planner", options.planner,
               "Decide every goal again, too, and compare pose, path, fitness and search exactly");
  app.add_option("--run", run, "The run to replay, when the log holds several");
  app.set_version_flag("--version", "nextview_replay " + std::string(nextview::program_version()));
  app.footer(
      "Exit status: 0 when all of it agrees; 1 when something differs, or the log cannot be read;\n"
      "3 when what is there agrees and something is missing. A line names each message that\n"
      "differs, with its fields, or is missing.");
  CLI11_PARSE(app, argc, argv);
  try {
    return replay_run(folder, run, options);
  } catch (const std::exception& error) {
    std::cerr << "nextview_replay: " << error.what() << std::endl;
    return 1;
  }
}

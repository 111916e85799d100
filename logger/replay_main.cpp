#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <utility>

#include "lcmtypes/nearest_option.h"
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

/// What there is, channel by channel.
void show_events(const nextview::RunLog& log) {
  std::cout << log.contents().events() << " events:";
  const char* separator = " ";
  for (const auto& [channel, events] : log.contents().events_on()) {
    std::cout << std::exchange(separator, ", ") << events << " "
              << (channel.empty() ? "without a channel" : channel);
  }
  std::cout << "; " << log.counters().repeated << " repeated\n";
}

void show_unchecked(const std::vector<nextview::UncheckedFields>& unchecked,
                    const nextview::ReplayReport& report) {
  if (!report.sealed) {
    std::cout << "not checked, as the log bears no seal:\n"
                 "  every event (nothing depends on it): when it was received\n";
  } else if (report.exit_status() == 0) {
    std::cout << "not worked out again, but what it was when the log was sealed:\n";
  } else {
    std::cout << "not worked out again:\n";
  }
  for (const nextview::UncheckedFields& some : unchecked) {
    std::cout << "  " << some.channel << " (" << some.why << "):";
    for (const std::string& field : some.fields) {
      std::cout << " " << field;
    }
    std::cout << "\n";
  }
}

std::vector<std::filesystem::path> files_of(const std::vector<std::string>& arguments) {
  if (arguments.size() == 1) return nextview::log_files_of(arguments.front());
  return {arguments.begin(), arguments.end()};
}

int replay_run(const std::vector<std::string>& arguments, std::optional<std::int64_t> run,
               const std::optional<nextview::RunKey>& key, const nextview::ReplayOptions& options) {
  const std::vector<std::filesystem::path> files = files_of(arguments);
  const std::filesystem::path& file = files.front();
  nextview::RunLog log(files, run, nextview::RangeImages::Keep, key);
  log.read_on();
  show_events(log);
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
  if (const std::int64_t some = log.counters().signatures_unchecked; some > 0) {
    std::cout << some << " messages are signed, which was not checked: --key-file names the key\n";
  }
  const bool all = report.differences.empty();
  std::cout << report.views << " views replayed"
            << (all ? ", every map as it was in the run" : " to the map they had in the run");
  if (options.planner) {
    std::cout << "; " << report.goals << " goals decided again"
              << (all ? ", every one the same" : " to the same");
  }
  std::cout << " (" << (report.stop_reason.empty() ? "no end" : report.stop_reason) << ")\n";
  if (log.record().config()) {
    show_unchecked(nextview::unchecked_fields(log.record(), options.planner), report);
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
  std::vector<std::string> folders;
  std::optional<std::int64_t> run;
  nextview::ReplayOptions options;
  app.add_option("DIR", folders,
                 "Folder of a run, or an LCM log; several files: of one log that was split, in the "
                 "order in which they were recorded")
      ->required();
  CLI::Option* const decide = app.add_flag(
      "--planner", options.planner,
      "Decide every goal again, too, and compare pose, path, fitness and search exactly");
  app.add_option("--threads", options.threads,
                 "Threads to decide with, in place of the run's; the result does not depend on it")
      ->needs(decide);
  app.add_option("--run", run, "The run to replay, when the log holds several");
  std::string key_file;
  app.add_option("--key-file", key_file,
                 "The key of a run that had one: messages that it has not signed are left out");
  app.failure_message(nextview::what_is_wrong);
  app.set_version_flag("--version", "nextview_replay " + std::string(nextview::program_version()));
  app.footer(
      "Exit status: 0 when all of it agrees; 1 when something differs, or the log cannot be read;\n"
      "3 when what is there agrees and something is missing. A line names each message that\n"
      "differs, with its fields, or is missing.");
  CLI11_PARSE(app, argc, argv);
  try {
    std::optional<nextview::RunKey> key;
    if (!key_file.empty()) key = nextview::RunKey::read(key_file);
    return replay_run(folders, run, key, options);
  } catch (const std::exception& error) {
    std::cerr << "nextview_replay: " << error.what() << std::endl;
    return 1;
  }
}

#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>
#include <system_error>
#include <utility>

#include "lcmtypes/open_files.h"
#include "lcmtypes/standard_output.h"
#include "runner/exit_status.h"
#include "runner/run_network.h"
#include "runner/run_signals.h"
#include "runner/run_supervisor.h"

namespace {

using nextview::ArtefactFiles;
using nextview::FinishedRun;

/// Writes a whole file or none, so that a run without it can be told from one that is over.
void write_artefact(const std::filesystem::path& file, const FinishedRun& run,
                    void (*write)(std::ostream&, const FinishedRun&)) {
  const std::filesystem::path unfinished = file.string() + ".part";
  std::ofstream out(unfinished);
  write(out, run);
  out.close();
  std::error_code error(errno, std::generic_category());
  if (out) {
    std::filesystem::rename(unfinished, file, error);
    if (!error) return;
  }
  std::error_code ignored;
  std::filesystem::remove(unfinished, ignored);
  throw std::runtime_error("cannot write " + file.string() + ": " + error.message());
}

/// @return why views.csv and summary.json could not be written; empty when they are
std::string write_artefacts(const FinishedRun& run, const ArtefactFiles& files) {
  try {
    write_artefact(files.views, run, nextview::write_views);
    write_artefact(files.summary, run, nextview::write_summary);
    return {};
  } catch (const std::exception& error) {
    return error.what();
  }
}

/// A run that is to be taken up again and is over already, with all its artefacts. One that was
/// interrupted when its planner had just ended it has tables that say otherwise than its log.
bool is_over(const nextview::EarlierRun& earlier, const ArtefactFiles& files) {
  if (!earlier.is_whole()) return false;
  const nextview::stop_t& stop = *earlier.record().stop();
  std::ifstream file(files.summary);
  const auto summary = nlohmann::json::parse(file, nullptr, /*allow_exceptions=*/false);
  if (!summary.is_object() || summary.value("stop_reason", "") != stop.stop_reason) return false;
  std::cout << files.log.string() << ": this run has ended, " << stop.stop_reason << " after "
            << stop.views << " views" << std::endl;
  return true;
}

int carry_out(const nextview::RunOptions& options, nextview::RunNetwork network,
              nextview::RunSetup setup, nextview::RunFolder folder,
              std::optional<nextview::EarlierRun> earlier,
              nextview::RunSupervisor::Clock::time_point start) {
  const ArtefactFiles files(folder.path());
  // Not before: a CAD file may take for ever to read, and until here there is nothing to save.
  nextview::note_signals();
  using Style = nextview::Progress::Style;
  nextview::Progress progress(std::cout, ::isatty(STDOUT_FILENO) ? Style::Bar : Style::Lines,
                              setup.config.planner.max_views);
  for (const std::string& warning : setup.warnings) progress.say("warning: " + warning);
  nextview::RunSupervisor supervisor(options, std::move(network), std::move(setup),
                                     std::move(folder), std::move(earlier), progress);
  const FinishedRun finished = supervisor.carry_out(start);
  progress.finish();
  const std::string unwritten = write_artefacts(finished, files);
  nextview::write_table(std::cout, finished);
  std::cout << "  " << files.log.string() << "\n  " << files.views.string() << "\n  "
            << files.summary.string() << std::endl;
  if (!unwritten.empty()) std::cerr << "nextview_run: " << unwritten << std::endl;
  if (nextview::noted_signal() != 0) return 128 + nextview::noted_signal();
  const int status = nextview::exit_status(finished.stop_reason);
  if (status != 0) {
    std::cerr << "nextview_run: " << finished.stop_reason << ": " << finished.stop_detail
              << std::endl;
  }
  supervisor.show_until_closed();
  return status == 0 && !unwritten.empty() ? 1 : status;
}

int resume(const nextview::RunOptions& options, nextview::RunSupervisor::Clock::time_point start) {
  auto folder = nextview::RunFolder::of_earlier_run(options.resume);
  const ArtefactFiles files(folder.path());
  nextview::EarlierRun earlier(files.log, nextview::run_key_of(options));
  if (is_over(earlier, files)) return 0;
  nextview::RunOptions resumed = options;
  if (!earlier.config().has_scene) resumed.without = {"sensor_sim", "base_sim"};
  nextview::RunNetwork network = nextview::enter_network(resumed);
  nextview::RunSetup setup = nextview::set_up_again(earlier.config());
  nextview::fill_window(setup, options);
  return carry_out(resumed, std::move(network), std::move(setup), std::move(folder),
                   std::move(earlier), start);
}

int run(const nextview::RunOptions& options, nextview::RunSupervisor::Clock::time_point start) {
  const std::string too_few = nextview::too_few_open_files(nextview::kOpenFilesOfRun);
  if (!too_few.empty()) throw nextview::SetupError(too_few);
  if (!options.resume.empty()) return resume(options, start);
  nextview::RunNetwork network = nextview::enter_network(options);
  nextview::RunSetup setup = nextview::prepare_run(options);
  auto folder = nextview::RunFolder::make(options, setup.config.scene_name);
  return carry_out(options, std::move(network), std::move(setup), std::move(folder), std::nullopt,
                   start);
}

}  // namespace

int main(int argc, char** argv) {
  nextview::answer_for_standard_output();
  const auto start = nextview::RunSupervisor::Clock::now();
  int exit_status = 0;
  const auto options =
      nextview::parse_run_options(argc, argv, exit_status, nextview::kRunDescription);
  if (!options) return exit_status;
  std::signal(SIGPIPE, SIG_IGN);
  try {
    return run(*options, start);
  } catch (const std::exception& error) {
    std::cerr << "nextview_run: " << error.what() << std::endl;
    return nextview::noted_signal() != 0 ? 128 + nextview::noted_signal() : 1;
  }
}

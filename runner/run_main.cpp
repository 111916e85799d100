#include <fmt/chrono.h>
#include <unistd.h>

#include <csignal>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iostream>

#include "runner/exit_status.h"
#include "runner/run_signals.h"
#include "runner/run_supervisor.h"

namespace {

using nextview::ArtefactFiles;
using nextview::FinishedRun;
using nextview::SetupError;

std::string today() { return fmt::format("{:%Y%m%d-%H%M%S}", fmt::localtime(std::time(nullptr))); }

/// The folder for the run's artefacts, made if it is not there.
std::filesystem::path make_folder(const nextview::RunOptions& options,
                                  const std::string& scene_name) {
  std::filesystem::path folder = options.out;
  if (options.out.empty()) {
    const auto stem = std::filesystem::path(options.runs_folder) /
                      (scene_name + "-seed" + std::to_string(options.seed) + "-" + today());
    folder = stem;
    for (int i = 2; std::filesystem::exists(folder); ++i) {
      folder = stem.string() + "-" + std::to_string(i);
    }
  }
  if (std::filesystem::exists(ArtefactFiles(folder).log)) {
    throw SetupError("--out: " + folder.string() + " holds a run already: name another folder");
  }
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error || ::access(folder.c_str(), W_OK) != 0) {
    throw SetupError("--out: " + folder.string() + " cannot be written to" +
                     (error ? ": " + error.message() : ""));
  }
  return folder;
}

void write_artefacts(const FinishedRun& run, const ArtefactFiles& files) {
  std::ofstream views(files.views);
  nextview::write_views(views, run);
  std::ofstream summary(files.summary);
  nextview::write_summary(summary, run);
  if (!views.flush() || !summary.flush()) {
    throw std::runtime_error("cannot write " + files.views.string() + " and " +
                             files.summary.string());
  }
}

int run(const nextview::RunOptions& options, nextview::RunSupervisor::Clock::time_point start) {
  nextview::RunSetup setup = nextview::prepare_run(options);
  const std::filesystem::path folder = make_folder(options, setup.config.scene_name);
  const ArtefactFiles files(folder);
  // Not before: a CAD file may take for ever to read, and until here there is nothing to save.
  nextview::note_signals();
  using Style = nextview::Progress::Style;
  nextview::Progress progress(std::cout, ::isatty(STDOUT_FILENO) ? Style::Bar : Style::Lines,
                              setup.config.planner.max_views);
  for (const std::string& warning : setup.warnings) progress.say("warning: " + warning);
  nextview::RunSupervisor supervisor(options, std::move(setup), folder, progress);
  const FinishedRun finished = supervisor.carry_out(start);
  progress.finish();
  write_artefacts(finished, files);
  nextview::write_table(std::cout, finished);
  std::cout << "  " << files.log.string() << "\n  " << files.views.string() << "\n  "
            << files.summary.string() << std::endl;
  if (nextview::noted_signal() != 0) return 128 + nextview::noted_signal();
  const int status = nextview::exit_status(finished.stop_reason);
  if (status != 0) {
    std::cerr << "nextview_run: " << finished.stop_reason << ": " << finished.stop_detail
              << std::endl;
  }
  supervisor.show_until_closed();
  return status;
}

}  // namespace

int main(int argc, char** argv) {
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

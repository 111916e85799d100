// Shows runs in a browser: of logs, or one that is going on.
#include <sys/resource.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <iostream>
#include <memory>
#include <optional>
#include <thread>
#include <vector>

#include "lcmtypes/nearest_option.h"
#include "lcmtypes/program_version.h"
#include "lcmtypes/standard_output.h"
#include "logger/recovered_run.h"
#include "viewer/page_port.h"
#include "viewer/run_source.h"
#include "viewer/view_server.h"

namespace {

using nextview::ServedRun;
using nextview::ViewedRun;

struct Options {
  std::vector<std::string> logs;
  std::string attach;
  std::int64_t run = 0;
  std::string key_file;
  bool paused = false;
  int port = -1;
  int listening = -1;
  std::string page;
};

std::string page_folder() {
  namespace fs = std::filesystem;
  const fs::path bin = fs::read_symlink("/proc/self/exe").parent_path();
  const fs::path installed = bin.parent_path() / NEXTVIEW_DATA_FOLDER / "page";
  return fs::is_directory(installed) ? installed.string() : NEXTVIEW_PAGE_FOLDER;
}

std::string name_of(const std::string& folder_or_log) {
  auto path = std::filesystem::weakly_canonical(std::filesystem::absolute(folder_or_log));
  if (path.filename() == "run.lcmlog") path = path.parent_path();
  return path.filename().string();
}

std::unique_ptr<nextview::ViewServer> make_server(std::deque<ServedRun>& runs,
                                                  const Options& options) {
  const std::string page = options.page.empty() ? page_folder() : options.page;
  if (options.listening >= 0) {
    return std::make_unique<nextview::ViewServer>(runs, page,
                                                  nextview::ListeningSocket{options.listening});
  }
  if (options.port >= 0) {
    return std::make_unique<nextview::ViewServer>(runs, page,
                                                  static_cast<std::uint16_t>(options.port));
  }
  try {
    return std::make_unique<nextview::ViewServer>(runs, page, nextview::kPagePort);
  } catch (const std::runtime_error&) {
    return std::make_unique<nextview::ViewServer>(runs, page, 0);
  }
}

/// Follows a run in a thread; what ends it early is said on the page and here.
std::jthread follow(ViewedRun& viewed,
                    std::function<void(ViewedRun&, const std::stop_token&)> source) {
  return std::jthread([&viewed, source = std::move(source)](const std::stop_token& stop) {
    try {
      source(viewed, stop);
    } catch (const std::exception& error) {
      viewed.set_note(error.what());
      std::cerr << "nextview_viewer: " << error.what() << std::endl;
    }
  });
}

void show(const Options& options) {
  // A run must not be slowed by who looks on.
  setpriority(PRIO_PROCESS, 0, 15);
  for (const std::string& log : options.logs) {
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(nextview::log_file_of(log), ignored)) {
      throw std::runtime_error(log + ": holds no run.lcmlog; name the folder of a run, or a log");
    }
  }
  std::deque<ServedRun> runs;
  for (const std::string& log : options.logs) runs.emplace_back(name_of(log));
  if (!options.attach.empty()) {
    ViewedRun& viewed = runs.emplace_back("the run on the bus").viewed;
    viewed.set_pausable();
    if (options.paused) viewed.set_pace(0);
  }
  std::optional<nextview::RunKey> key;
  if (!options.key_file.empty()) key = nextview::RunKey::read(options.key_file);
  const auto server = make_server(runs, options);
  std::vector<std::jthread> followers;
  for (std::size_t i = 0; i < options.logs.size(); ++i) {
    followers.push_back(follow(runs[i].viewed, [&log = options.logs[i]](auto& viewed, auto& stop) {
      nextview::follow_log(log, viewed, stop);
    }));
  }
  if (!options.attach.empty()) {
    followers.push_back(follow(runs.back().viewed, [&options, key](auto& viewed, auto& stop) {
      nextview::follow_bus(options.attach, options.run, key, viewed, stop);
    }));
  }
  server->end_on_signals();
  std::cout << "view: http://127.0.0.1:" << server->port() << "/" << std::endl;
  server->serve();
}

}  // namespace

int main(int argc, char** argv) {
  nextview::answer_for_standard_output();
  CLI::App app{
      "Shows runs in a browser: the room as it is being recovered, view by view. Serves a page on\n"
      "this machine, 127.0.0.1, only, until Ctrl-C.\n"};
  Options options;
  app.add_option("RUN", options.logs, "Folders of runs, or their logs; a run may still go on");
  app.add_option("--attach", options.attach,
                 "LCM URL of a run that is going on, such as udpm://239.255.76.67:7667?ttl=0; "
                 "nextview_run --verbose says it");
  app.add_option("--run", options.run, "With --attach: its number; default: the first one heard")
      ->check(CLI::PositiveNumber);
  app.add_option("--key-file", options.key_file, "With --attach: the key of a run that has one");
  app.add_flag("--paused", options.paused,
               "With --attach: the run waits from the start until the page lets it go on");
  app.add_option("--port", options.port, "Port of the page; default 7660 if it is free, 0: any")
      ->check(CLI::Range(0, 65535));
  app.add_option("--listening", options.listening,
                 "In place of --port: a socket that listens already, as ./run --view has made it "
                 "outside its own network")
      ->check(CLI::NonNegativeNumber);
  app.add_option("--page", options.page, "Folder of the built page; default: as it was built");
  app.failure_message(nextview::what_is_wrong);
  app.set_version_flag("--version", "nextview_viewer " + std::string(nextview::program_version()));
  CLI11_PARSE(app, argc, argv);
  try {
    if (options.logs.empty() && options.attach.empty()) {
      throw std::runtime_error("name the folder of a run, or --attach URL");
    }
    show(options);
  } catch (const std::exception& error) {
    std::cerr << "nextview_viewer: " << error.what() << std::endl;
    return 1;
  }
  return 0;
}

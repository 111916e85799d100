#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <string>

#include "lcmtypes/bus.h"

namespace CLI {
class App;
}

namespace nextview {

/// What one process of a run does, apart from what they all do. Message handlers, set up in the
/// constructor, only keep what comes; the work is done in step().
class BusProcess {
 public:
  virtual ~BusProcess() = default;

  /// Does the next piece of work that is ready; false when it has to wait for a message.
  virtual bool step() = 0;
  /// How long it may be left waiting for a message before its next step.
  virtual std::chrono::milliseconds longest_wait() const {
    return std::chrono::milliseconds::max();
  }
  /// Whether ask_again() would ask for anything: whether it waits for somebody to answer, and not
  /// only for something new.
  virtual bool waits() const { return true; }
  /// Requests what it waits for. Called on a timer, ever less often until something comes; at once
  /// while it is behind the run.
  virtual void ask_again() {}
  /// Whether it waits for a message of a view that the run had got to before it was started.
  virtual bool behind() const { return false; }
  /// Somebody waits for a message that has not been published: asks for its own input when the
  /// message is one it will publish, and waits for that from then on.
  virtual void on_missing(const request_t& request) = 0;

  /// It takes the place of one that has ended after the run had got to this view: everything up to
  /// there has been said, and is to be had for the asking.
  void catch_up_to(int view) { reached_ = view; }

 protected:
  /// The view the run had got to before it was started; 0 in a run that begins.
  int reached() const { return reached_; }

 private:
  int reached_ = 0;
};

using MakeBusProcess =
    std::function<std::unique_ptr<BusProcess>(Bus& bus, const run_config_t& config)>;

/// Whether SIGINT, SIGTERM or SIGHUP has asked this process, run by run_bus_process, to end: for
/// work that takes long and would better be given up.
bool end_requested();

/// Of a simulator, for run_bus_process: --real-time, see RealTime.
void add_real_time_option(CLI::App& app, double& real_time);

/// The main of a process: parses the command line (--lcm-url, --run, --catch-up), asks for the
/// run's configuration until it comes, makes the process, says by a status_t that it is there, and
/// serves the bus until SIGINT, SIGTERM or SIGHUP. Answers requests for status_t.
/// @param about what --help says first
/// @param add_options adds options of this process alone, such as have no influence on results: all
///        others come with the configuration
/// @return the exit status: 0 after a signal; 1 after an error, which is printed in one line and
///         published in a status_t; CLI11's after a wrong command line
int run_bus_process(int argc, char** argv, const std::string& role, const std::string& about,
                    const MakeBusProcess& make,
                    const std::function<void(CLI::App&)>& add_options = {});

}  // namespace nextview

#pragma once

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
  /// Requests what it waits for. Called on a timer, ever less often until something comes.
  virtual void ask_again() {}
  /// Somebody waits for a message that has not been published: asks for its own input when the
  /// message is one it will publish.
  virtual void on_missing(const request_t& request) = 0;
};

using MakeBusProcess =
    std::function<std::unique_ptr<BusProcess>(Bus& bus, const run_config_t& config)>;

/// Whether SIGINT or SIGTERM has asked this process, run by run_bus_process, to end: for work that
/// takes long and would better be given up.
bool end_requested();

/// The main of a process: parses the command line (--lcm-url, --run), asks for the run's
/// configuration until it comes, makes the process, says by a status_t that it is there, and serves
/// the bus until SIGINT or SIGTERM. Answers requests for status_t.
/// @param about what --help says first
/// @param add_options adds options of this process alone, such as have no influence on results: all
///        others come with the configuration
/// @return the exit status: 0 after a signal; 1 after an error, which is printed in one line and
///         published in a status_t; CLI11's after a wrong command line
int run_bus_process(int argc, char** argv, const std::string& role, const std::string& about,
                    const MakeBusProcess& make,
                    const std::function<void(CLI::App&)>& add_options = {});

}  // namespace nextview

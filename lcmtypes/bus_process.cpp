#include "lcmtypes/bus_process.h"

#include <CLI/CLI.hpp>
#include <csignal>
#include <filesystem>
#include <iostream>
#include <optional>

#include "lcmtypes/nearest_option.h"
#include "lcmtypes/parameter_bounds.h"
#include "lcmtypes/program_version.h"
#include "lcmtypes/serve.h"
#include "lcmtypes/standard_output.h"

namespace nextview {
namespace {

volatile std::sig_atomic_t stop_requested = 0;

void request_stop(int /*signal*/) { stop_requested = 1; }

void end_on_signals() {
  struct sigaction action {};
  action.sa_handler = request_stop;  // without SA_RESTART: a wait is interrupted
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) sigaction(number, &action, nullptr);
}

}  // namespace

bool end_requested() { return stop_requested != 0; }

void add_real_time_option(CLI::App& app, double& real_time) {
  app.add_option("--real-time", real_time,
                 "Simulated seconds a second, for watching; what is said is the same. 0: at once")
      ->check(CLI::Range(0.0, bounds::kRealTime.most))
      ->capture_default_str();
}

int run_bus_process(int argc, char** argv, const std::string& role, const std::string& about,
                    const MakeBusProcess& make, const std::function<void(CLI::App&)>& add_options) {
  answer_for_standard_output();
  CLI::App app{about};
  std::string lcm_url;
  std::int64_t run = 0;
  std::string key_file;
  int catch_up = 0;
  app.add_option("--lcm-url", lcm_url,
                 "LCM URL of the run, such as udpm://239.255.76.67:7667?ttl=0; without it "
                 "LCM_DEFAULT_URL is used, else LCM's default");
  app.add_option("--run", run, "The run to take part in; messages of other runs are ignored")
      ->required();
  app.add_option("--catch-up", catch_up,
                 "Take the place of a process that has ended after the run had got to this view: "
                 "what has been said up to there is asked for at once");
  app.add_option("--key-file", key_file,
                 "The run's key: what is said is signed by it, and what is heard must be");
  if (add_options) add_options(app);
  const std::string program = std::filesystem::path(argv[0]).filename();
  app.failure_message(what_is_wrong);
  app.set_version_flag("--version", program + " " + std::string(program_version()));
  app.footer(
      "Everything else comes from the run's configuration, NEXTVIEW_RUN_CONFIG on the bus,\n"
      "which is asked for until somebody publishes it. SIGINT, SIGTERM and SIGHUP end the\n"
      "process cleanly, with exit status 0.");
  CLI11_PARSE(app, argc, argv);
  end_on_signals();

  std::optional<Bus> bus;
  try {
    std::optional<RunKey> key;
    if (!key_file.empty()) key = RunKey::read(key_file);
    bus.emplace(lcm_url, run, role, key);
    serve(*bus, make, end_requested, catch_up);
    return 0;
  } catch (const std::exception& error) {
    if (end_requested()) return 0;  // what was given up for that is no failure
    std::cerr << "nextview_" << role << ": " << error.what() << std::endl;
    try {
      if (bus) publish_status(*bus, error.what());
    } catch (const std::exception&) {
      // The bus itself is what failed; the line above and the exit status say so.
    }
    return 1;
  }
}

}  // namespace nextview

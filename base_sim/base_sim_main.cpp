#include "base_sim/base_sim_process.h"

int main(int argc, char** argv) {
  double real_time = 0.0;
  return nextview::run_bus_process(
      argc, argv, "base_sim",
      "The simulated mobile base of a nextview run, with lift, pan and tilt. It moves to every "
      "goal\n"
      "along the path the goal gives, or refuses it when its body would touch the run's CAD scene\n"
      "or a limit is in the way, and says which (NEXTVIEW_ARRIVAL).",
      [&real_time](nextview::Bus& bus, const nextview::run_config_t& config) {
        return std::make_unique<nextview::BaseSimProcess>(bus, config, nextview::end_requested,
                                                          real_time);
      },
      [&real_time](CLI::App& app) { nextview::add_real_time_option(app, real_time); });
}

#include "sensor_sim/sensor_sim_process.h"

int main(int argc, char** argv) {
  double real_time = 0.0;
  return nextview::run_bus_process(
      argc, argv, "sensor_sim",
      "The simulated range sensor of a nextview run. For every arrival of the base it casts the\n"
      "sensor's rays into the run's CAD scene and publishes a range image (NEXTVIEW_RANGE_IMAGE).",
      [&real_time](nextview::Bus& bus, const nextview::run_config_t& config) {
        return std::make_unique<nextview::SensorSimProcess>(bus, config, nextview::end_requested,
                                                            real_time);
      },
      [&real_time](CLI::App& app) { nextview::add_real_time_option(app, real_time); });
}

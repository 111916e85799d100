#include <CLI/CLI.hpp>

#include "sensor_sim/sensor_sim_process.h"

int main(int argc, char** argv) {
  double real_time = 0.0;
  std::size_t part_bytes = nextview::kPartBytes;
  return nextview::run_bus_process(
      argc, argv, "sensor_sim",
      "The simulated range sensor of a nextview run. For every arrival of the base it casts the\n"
      "sensor's rays into the run's CAD scene and publishes a range image (NEXTVIEW_RANGE_IMAGE).",
      [&](nextview::Bus& bus, const nextview::run_config_t& config) {
        return std::make_unique<nextview::SensorSimProcess>(bus, config, nextview::end_requested,
                                                            real_time, part_bytes);
      },
      [&](CLI::App& app) {
        nextview::add_real_time_option(app, real_time);
        app.add_option("--part-bytes", part_bytes,
                       "Of ray table and ranges a part of a range image carries at most: small "
                       "enough for a packet where packets may be lost. All of a run must be cut "
                       "alike")
            ->check(CLI::Range(std::size_t{16}, nextview::kPartBytes))
            ->capture_default_str();
      });
}

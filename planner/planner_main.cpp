#include "planner/planner_process.h"

int main(int argc, char** argv) {
  return nextview::run_bus_process(
      argc, argv, "planner",
      "The planner of a nextview run. From the range images it keeps a map of its own, equal to "
      "the\n"
      "mapper's, and decides where to scan from next (NEXTVIEW_GOAL, NEXTVIEW_SEARCH) until there\n"
      "is nothing left to see (NEXTVIEW_STOP). It knows of the scene only what the images say.",
      [](nextview::Bus& bus, const nextview::run_config_t& config) {
        return std::make_unique<nextview::PlannerProcess>(bus, config);
      });
}

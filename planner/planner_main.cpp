#include <unistd.h>

#include <cstdlib>

#include "planner/planner_process.h"

namespace {

/// Has this program's idle threads (--threads) fall asleep after about a millisecond without work;
/// GCC's default of 300 000 turns keeps them awake for so long that, where cores are scarce, nobody
/// else gets on. OpenMP reads that from the environment before main begins and can be told in no
/// other way, so the program starts itself anew, once. Whoever has set it is obeyed.
void limit_idle_threads(char** argv) {
  constexpr int kReplace = 1;
  if (std::getenv("GOMP_SPINCOUNT") != nullptr) return;
  ::setenv("GOMP_SPINCOUNT", "30000", kReplace);
  ::execv("/proc/self/exe", argv);  // returns only when it cannot; then the default it is
}

}  // namespace

int main(int argc, char** argv) {
  limit_idle_threads(argv);
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

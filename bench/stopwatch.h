#pragma once

#include <time.h>

namespace nextview {

inline double seconds_of(clockid_t clock) {
  timespec now;
  clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Runs something and says how long it took by the clock on the wall, in seconds.
template <class F>
double wall_s(F&& f) {
  const double start_s = seconds_of(CLOCK_MONOTONIC);
  f();
  return seconds_of(CLOCK_MONOTONIC) - start_s;
}

/// The same in time of this thread, whatever else the machine does: for what works in one thread.
template <class F>
double thread_s(F&& f) {
  const double start_s = seconds_of(CLOCK_THREAD_CPUTIME_ID);
  f();
  return seconds_of(CLOCK_THREAD_CPUTIME_ID) - start_s;
}

}  // namespace nextview

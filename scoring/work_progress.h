#pragma once

#include <atomic>
#include <cstdint>

namespace nextview {

/// How far the work has come; may be read by another thread.
struct WorkProgress {
  std::atomic<const char*> stage = "";  ///< what is being worked out, in words
  std::atomic<std::int64_t> done = 0;   ///< of this stage
  std::atomic<std::int64_t> of = 0;     ///< 0 while it is not known

  void begin(const char* next_stage, std::int64_t next_of) {
    of = 0;
    done = 0;
    stage = next_stage;
    of = next_of;
  }
};

}  // namespace nextview

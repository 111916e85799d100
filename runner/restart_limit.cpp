#include "runner/restart_limit.h"

namespace nextview {

bool RestartLimit::allows(const std::string& role, std::int64_t progress) {
  Tries& tries = tries_[role];
  if (progress > tries.progress) tries = {progress, 0};
  return ++tries.count <= kTries;
}

}  // namespace nextview

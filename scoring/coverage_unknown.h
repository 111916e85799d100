#pragma once

#include <stdexcept>

namespace nextview {

/// Coverage cannot be told; the message says why, to go after "coverage unknown, because ".
class CoverageUnknown : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace nextview

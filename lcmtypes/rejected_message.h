#pragma once

#include <cstdint>
#include <stdexcept>

#include "lcmtypes/channels.h"

namespace nextview {

/// Thrown by a handler that finds a well-formed message impossible in its run (an unknown view,
/// say) and has ignored it. The bus then drops it like any other message that cannot be right.
class RejectedMessage : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Whether a run can have an attempt of a view.
/// @throws RejectedMessage when it cannot
void check_fits_run(const run_config_t& config, std::int32_t view, std::int32_t attempt);

}  // namespace nextview

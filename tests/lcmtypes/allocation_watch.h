#pragma once

#include <cstddef>

namespace nextview {

/// Starts to watch the sizes of this program's allocations (operator new is replaced).
void watch_allocations();
/// The largest one since, bytes.
std::size_t largest_allocation();

}  // namespace nextview

#pragma once

#include <functional>

namespace nextview {

/// Has every core do the same work, which divides itself up, and waits until all are done. The
/// threads are started by the one that calls, which works too, and so, on Linux, have its priority.
/// @throws what the work throws, of one of those that have failed
void on_all_cores(const std::function<void()>& work);

}  // namespace nextview

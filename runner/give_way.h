#pragma once

namespace nextview {

/// The niceness of what looks on.
inline constexpr int kLookingOnNice = 15;

/// Lowers the calling thread's priority, and with it that of the threads it starts. Looking on and
/// scoring must not take time from the processes that do the work: on two cores the share of a run
/// that is waiting falls by a quarter.
void give_way();

}  // namespace nextview

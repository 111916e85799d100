#pragma once

namespace nextview {

/// From now on SIGINT, SIGTERM and SIGHUP are only noted, and waits are interrupted by them; what
/// is ignored already stays so.
void note_signals();
/// The signal that was noted, or 0.
int noted_signal();

}  // namespace nextview

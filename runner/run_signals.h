#pragma once

namespace nextview {

/// From now on SIGINT and SIGTERM are only noted, and waits are interrupted by them.
void note_signals();
/// The signal that was noted, or 0.
int noted_signal();

}  // namespace nextview

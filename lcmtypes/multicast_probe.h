#pragma once

#include <string>

namespace nextview {

/// Sends a datagram to the multicast group and port of an LCM udpm URL and waits for it to come
/// back. LCM's own test of this takes 10 s to fail and then aborts; this one takes at most 1.5 s.
/// What is sent is too short to be a message, so that LCM ignores it and no log has it.
/// @param lcm_url udpm://... as LCM has it; empty: LCM's default group and port
/// @throws BusError when the datagram cannot be sent or does not come back, saying what to type
void probe_multicast(const std::string& lcm_url);

}  // namespace nextview

#pragma once

#include <string>

namespace nextview {

/// Finds out whether messages travel at an LCM URL before LCM is asked for it, which would hang,
/// abort, or complain without an end where they do not.
/// @param lcm_url udpm://..., tcpq://..., or empty for LCM's default, which is udpm
/// @throws BusError saying what is wrong and what to type
void probe_bus(const std::string& lcm_url);

}  // namespace nextview

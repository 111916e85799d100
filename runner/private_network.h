#pragma once

#include <string>

namespace nextview {

/// A network of this process's own, and of those it starts from here on: a loopback that carries
/// multicast, and no way out or in. To be entered before this process has other threads, as they
/// would stay outside.
/// @return empty when it has been entered, else why not; then all is as it was
std::string enter_private_network();

/// Why there can be none here; empty when there can. Tried by a process that ends at once.
std::string why_no_private_network();

/// What to type before a command that is to run in the network of a process, as this user.
std::string command_to_join_network_of(long pid);

}  // namespace nextview

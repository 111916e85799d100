#pragma once

#include <optional>
#include <string>

#include "lcmtypes/run_key.h"
#include "runner/file_descriptor.h"
#include "runner/run_options.h"

namespace nextview {

/// The network in which the processes of a run meet.
struct RunNetwork {
  bool own = false;  ///< nobody else is in it
  /// For the user, when nobody was expected from outside and yet others can be heard; else empty.
  std::string note;
  /// A socket on 127.0.0.1 of the network outside, for the page of --view, which a browser there
  /// has to reach. Only in a network of the run's own.
  FileDescriptor page;
};

/// Enters a network of the run's own (private_network.h) when --private says so; without a word
/// also where that is allowed and nobody is expected on the bus from outside. To be called before
/// the program has other threads.
/// @throws SetupError when --private was asked for and there can be none
RunNetwork enter_network(const RunOptions& options);

/// The key of --key-file; nothing without one.
/// @throws BusError naming the file when it holds none
std::optional<RunKey> run_key_of(const RunOptions& options);

}  // namespace nextview

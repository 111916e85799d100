#pragma once

#include <stdexcept>
#include <string>

#include "runner/file_descriptor.h"

namespace nextview {

/// No UDP port is free for a run; the message says what to do.
class NoFreePort : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A UDP port that belongs to one run on this machine until the object or the process ends.
///
/// LCM binds its ports with SO_REUSEPORT, so it does not notice that one is taken, and a different
/// multicast group does not keep two runs apart: only the port does. The lock is an abstract Unix
/// socket named after the port, which the kernel takes away with the process however it ends; ports
/// bound by programs that know nothing of the lock are found in /proc/net/udp.
class PortLock {
 public:
  static constexpr int kFirstPort = 7700;
  static constexpr int kLastPort = 7899;

  /// The lowest free port of the range.
  /// @throws NoFreePort when all are taken
  static PortLock acquire(int first = kFirstPort, int last = kLastPort);

  int port() const { return port_; }
  /// Where a run on this port meets: multicast that does not leave the machine.
  std::string lcm_url() const;

 private:
  PortLock(int port, FileDescriptor socket) : port_(port), socket_(std::move(socket)) {}

  int port_;
  FileDescriptor socket_;
};

}  // namespace nextview

#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lcmtypes/udpm_socket.h"

namespace nextview {

/// Hears LCM's udpm datagrams in place of liblcm, which believes what fragments and empty channel
/// names say. A thread takes what the kernel has, so that nothing is lost while its owner works, up
/// to kMostWaiting; then what comes is refused, and whoever misses it asks again.
///
/// Where nothing is sent beyond this machine (ttl=0) nothing from beyond it is heard either: only
/// what comes from one of its own addresses, which the kernel lets nobody else claim.
class UdpmReader {
 public:
  /// Bytes of messages that wait to be handled.
  static constexpr std::size_t kMostWaiting = 24u << 20;

  struct Message {
    std::string channel;
    std::vector<std::uint8_t> bytes;
  };

  /// @throws BusError when the group cannot be heard here
  explicit UdpmReader(const UdpmPlace& place);
  ~UdpmReader();

  /// Only messages of channels that were named are kept.
  void listen_to(std::string_view channel);
  /// The next message; nothing when none came in time or a signal interrupted the wait.
  /// @throws BusError when nothing can be received any more
  std::optional<Message> next(std::chrono::milliseconds timeout);
  /// Datagrams refused since the last call, by the reason.
  std::map<std::string, std::int64_t> take_refused();

 private:
  struct Shared;  // with the thread
  std::unique_ptr<Shared> shared_;
};

}  // namespace nextview

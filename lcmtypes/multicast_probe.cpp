#include "lcmtypes/multicast_probe.h"

#include <poll.h>
#include <sys/socket.h>

#include <array>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <random>

#include "lcmtypes/transport.h"
#include "lcmtypes/udpm_socket.h"

namespace nextview {
namespace {

// An LCM header has 8 bytes; a shorter datagram is discarded without a word.
using Nonce = std::array<std::uint8_t, 7>;
// Where half of all datagrams are lost, one in 30 comes back all the same.
constexpr int kTries = 30;
constexpr std::chrono::milliseconds kPatience{50};

bool comes_back(int fd, const Nonce& nonce) {
  const auto deadline = std::chrono::steady_clock::now() + kPatience;
  while (true) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
        deadline - std::chrono::steady_clock::now());
    if (left.count() <= 0) return false;
    pollfd ready{fd, POLLIN, 0};
    if (poll(&ready, 1, static_cast<int>(left.count())) <= 0) continue;
    // One byte more than sent, so that a longer datagram is not mistaken for ours.
    std::array<std::uint8_t, sizeof(Nonce) + 1> received;
    const ssize_t size = recv(fd, received.data(), received.size(), MSG_DONTWAIT);
    if (size == static_cast<ssize_t>(nonce.size()) &&
        std::memcmp(received.data(), nonce.data(), nonce.size()) == 0) {
      return true;
    }
  }
}

}  // namespace

void probe_multicast(const std::string& lcm_url) {
  if (!is_udpm_url(lcm_url)) return;
  const UdpmPlace place = parse_udpm_url(lcm_url);
  const sockaddr_in destination = place.socket_address();
  const UdpmSocket socket(place);
  const std::uint8_t stay_on_this_host = 0;
  setsockopt(socket.fd(), IPPROTO_IP, IP_MULTICAST_TTL, &stay_on_this_host, 1);

  Nonce nonce;
  std::random_device entropy;
  for (std::uint8_t& byte : nonce) byte = static_cast<std::uint8_t>(entropy());
  for (int attempt = 0; attempt < kTries; ++attempt) {
    if (sendto(socket.fd(), nonce.data(), nonce.size(), 0,
               reinterpret_cast<const sockaddr*>(&destination), sizeof destination) < 0) {
      fail_on_udpm("send to", place);
    }
    if (comes_back(socket.fd(), nonce)) return;
  }
  throw BusError("nothing sent to " + place.address + ":" + std::to_string(place.port) +
                 " comes back: is UDP port " + std::to_string(place.port) +
                 " firewalled? See: nft list ruleset; ip route get " + place.address);
}

}  // namespace nextview

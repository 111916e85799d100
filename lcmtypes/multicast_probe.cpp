#include "lcmtypes/multicast_probe.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <random>

#include "lcmtypes/transport.h"

namespace nextview {
namespace {

// An LCM header has 8 bytes; a shorter datagram is discarded without a word.
using Nonce = std::array<std::uint8_t, 7>;
// Where half of all datagrams are lost, one in 30 comes back all the same.
constexpr int kTries = 30;
constexpr std::chrono::milliseconds kPatience{50};

struct Group {
  std::string address = "239.255.76.67";
  int port = 7667;
};

struct Socket {
  int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  Socket() = default;
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;
  ~Socket() {
    if (fd >= 0) close(fd);
  }
};

// udpm://[address[:port]][?options]
Group parse_group(const std::string& url) {
  Group group;
  const std::string prefix = "udpm://";
  if (url.empty()) return group;
  std::string place = url.substr(prefix.size());
  place = place.substr(0, place.find('?'));
  const std::size_t colon = place.find(':');
  if (colon != std::string::npos) {
    const std::string digits = place.substr(colon + 1);
    const char* end = digits.data() + digits.size();
    const auto [stop, error] = std::from_chars(digits.data(), end, group.port);
    if (error != std::errc{} || stop != end || group.port < 1 || group.port > 65535) {
      throw BusError("LCM URL '" + url + "': '" + digits + "' is not a port");
    }
  }
  const std::string address = place.substr(0, colon);
  if (!address.empty()) group.address = address;
  return group;
}

[[noreturn]] void fail_to(const std::string& what, const Group& group) {
  std::string advice;
  if (errno == ENODEV || errno == ENETUNREACH || errno == EADDRNOTAVAIL || errno == EHOSTUNREACH) {
    advice =
        ". There is no multicast route; type (as root): ip link set lo up; "
        "ip route add 224.0.0.0/4 dev lo";
  } else if (errno == EPERM || errno == EACCES) {
    advice = ". A firewall forbids it; allow UDP port " + std::to_string(group.port) + " to " +
             group.address;
  }
  throw BusError("cannot " + what + " multicast group " + group.address + ":" +
                 std::to_string(group.port) + ": " + std::strerror(errno) + advice);
}

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
  const Group group = parse_group(lcm_url);

  sockaddr_in destination{};
  destination.sin_family = AF_INET;
  destination.sin_port = htons(static_cast<std::uint16_t>(group.port));
  if (inet_pton(AF_INET, group.address.c_str(), &destination.sin_addr) != 1 ||
      !IN_MULTICAST(ntohl(destination.sin_addr.s_addr))) {
    throw BusError("LCM URL '" + lcm_url + "': '" + group.address + "' is not a multicast group");
  }

  const Socket socket;
  if (socket.fd < 0) fail_to("open a socket for", group);
  const int yes = 1;
  setsockopt(socket.fd, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  setsockopt(socket.fd, SOL_SOCKET, SO_REUSEPORT, &yes, sizeof yes);
  sockaddr_in here = destination;
  here.sin_addr.s_addr = htonl(INADDR_ANY);
  if (bind(socket.fd, reinterpret_cast<const sockaddr*>(&here), sizeof here) != 0) {
    fail_to("bind the port of", group);
  }
  ip_mreq membership{};
  membership.imr_multiaddr = destination.sin_addr;
  membership.imr_interface.s_addr = htonl(INADDR_ANY);
  if (setsockopt(socket.fd, IPPROTO_IP, IP_ADD_MEMBERSHIP, &membership, sizeof membership) != 0) {
    fail_to("join", group);
  }
  const std::uint8_t stay_on_this_host = 0;
  setsockopt(socket.fd, IPPROTO_IP, IP_MULTICAST_TTL, &stay_on_this_host, 1);

  Nonce nonce;
  std::random_device entropy;
  for (std::uint8_t& byte : nonce) byte = static_cast<std::uint8_t>(entropy());
  for (int attempt = 0; attempt < kTries; ++attempt) {
    if (sendto(socket.fd, nonce.data(), nonce.size(), 0,
               reinterpret_cast<const sockaddr*>(&destination), sizeof destination) < 0) {
      fail_to("send to", group);
    }
    if (comes_back(socket.fd, nonce)) return;
  }
  throw BusError("nothing sent to " + group.address + ":" + std::to_string(group.port) +
                 " comes back: is UDP port " + std::to_string(group.port) +
                 " firewalled? See: nft list ruleset; ip route get " + group.address);
}

}  // namespace nextview

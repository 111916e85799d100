#include "lcmtypes/udpm_socket.h"

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <string_view>

#include "lcmtypes/transport.h"

namespace nextview {
namespace {

constexpr std::string_view kPrefix = "udpm://";

bool read_number(std::string_view digits, int& number) {
  const char* end = digits.data() + digits.size();
  const auto [stop, error] = std::from_chars(digits.data(), end, number);
  return error == std::errc{} && stop == end;
}

/// Those that are missing, or that LCM would say something of, keep their default.
void read_options(std::string_view options, UdpmPlace& place) {
  while (!options.empty()) {
    const std::string_view option = options.substr(0, options.find('&'));
    options.remove_prefix(std::min(option.size() + 1, options.size()));
    const std::size_t equals = option.find('=');
    if (equals == std::string_view::npos) continue;
    const std::string_view name = option.substr(0, equals);
    int number = 0;
    if (!read_number(option.substr(equals + 1), number) || number < 0) continue;
    if (name == "ttl") place.ttl = number;
    if (name == "recv_buf_size") place.recv_buf_size = number;
  }
}

void ask_for_buffer(int fd, int bytes) {
  if (bytes <= 0) return;
  // Beyond the machine's limit where that is allowed.
  if (setsockopt(fd, SOL_SOCKET, SO_RCVBUFFORCE, &bytes, sizeof bytes) == 0) return;
  setsockopt(fd, SOL_SOCKET, SO_RCVBUF, &bytes, sizeof bytes);
}

}  // namespace

bool is_udpm_url(const std::string& lcm_url) {
  return lcm_url.empty() || lcm_url.starts_with(kPrefix);
}

sockaddr_in UdpmPlace::socket_address() const {
  sockaddr_in group{};
  group.sin_family = AF_INET;
  group.sin_port = htons(static_cast<std::uint16_t>(port));
  inet_pton(AF_INET, address.c_str(), &group.sin_addr);
  return group;
}

UdpmPlace parse_udpm_url(const std::string& lcm_url) {
  UdpmPlace place;
  if (!is_udpm_url(lcm_url)) throw BusError("LCM URL '" + lcm_url + "' is no udpm://");
  if (lcm_url.empty()) return place;
  const std::string rest = lcm_url.substr(kPrefix.size());
  const std::size_t question = rest.find('?');
  const std::string where = rest.substr(0, question);
  if (question != std::string::npos) {
    read_options(std::string_view(rest).substr(question + 1), place);
  }
  const std::size_t colon = where.find(':');
  if (colon != std::string::npos) {
    const std::string digits = where.substr(colon + 1);
    if (!read_number(digits, place.port) || place.port < 1 || place.port > 65535) {
      throw BusError("LCM URL '" + lcm_url + "': '" + digits + "' is not a port");
    }
  }
  if (const std::string address = where.substr(0, colon); !address.empty()) place.address = address;
  in_addr group{};
  if (inet_pton(AF_INET, place.address.c_str(), &group) != 1 ||
      !IN_MULTICAST(ntohl(group.s_addr))) {
    throw BusError("LCM URL '" + lcm_url + "': '" + place.address + "' is not a multicast group");
  }
  return place;
}

UdpmSocket::UdpmSocket(const UdpmPlace& place)
    : fd_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
  const auto require = [&](bool done, const std::string& what) {
    if (done) return;
    const int error = errno;
    if (fd_ >= 0) close(fd_);
    errno = error;
    fail_on_udpm(what, place);
  };
  require(fd_ >= 0, "open a socket for");
  ask_for_buffer(fd_, place.recv_buf_size);
  const int yes = 1;
  setsockopt(fd_, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  setsockopt(fd_, SOL_SOCKET, SO_REUSEPORT, &yes, sizeof yes);
  // To the group itself, not to any address: what is sent to the port of this machine is not heard.
  const sockaddr_in group = place.socket_address();
  require(bind(fd_, reinterpret_cast<const sockaddr*>(&group), sizeof group) == 0,
          "bind the port of");
  ip_mreq membership{};
  membership.imr_multiaddr = group.sin_addr;
  membership.imr_interface.s_addr = htonl(INADDR_ANY);
  require(setsockopt(fd_, IPPROTO_IP, IP_ADD_MEMBERSHIP, &membership, sizeof membership) == 0,
          "join");
  // Only what comes the way it was joined on, whatever others here have joined.
  const int no = 0;
  setsockopt(fd_, IPPROTO_IP, IP_MULTICAST_ALL, &no, sizeof no);
}

UdpmSocket::~UdpmSocket() { close(fd_); }

void fail_on_udpm(const std::string& what, const UdpmPlace& place) {
  std::string advice;
  if (errno == ENODEV || errno == ENETUNREACH || errno == EADDRNOTAVAIL || errno == EHOSTUNREACH) {
    advice =
        ". There is no multicast route; type (as root): ip link set lo up; "
        "ip route add 224.0.0.0/4 dev lo";
  } else if (errno == EPERM || errno == EACCES) {
    advice = ". A firewall forbids it; allow UDP port " + std::to_string(place.port) + " to " +
             place.address;
  }
  throw BusError("cannot " + what + " multicast group " + place.address + ":" +
                 std::to_string(place.port) + ": " + std::strerror(errno) + advice);
}

}  // namespace nextview

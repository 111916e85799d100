#include "runner/port_lock.h"

#include <sys/socket.h>
#include <sys/un.h>

#include <algorithm>
#include <cstddef>
#include <fstream>
#include <set>
#include <sstream>
#include <utility>

namespace nextview {
namespace {

/// Local ports of all UDP sockets of this network namespace.
std::set<int> bound_udp_ports() {
  std::set<int> ports;
  for (const char* table : {"/proc/net/udp", "/proc/net/udp6"}) {
    std::ifstream file(table);
    std::string line;
    std::getline(file, line);  // headings
    while (std::getline(file, line)) {
      std::istringstream columns(line);
      std::string slot;
      std::string local;  // ADDRESS:PORT in hexadecimal
      if (!(columns >> slot >> local)) continue;
      const std::size_t colon = local.rfind(':');
      if (colon == std::string::npos) continue;
      ports.insert(static_cast<int>(std::strtol(local.c_str() + colon + 1, nullptr, 16)));
    }
  }
  return ports;
}

/// The lock's socket, or none when somebody else holds it.
FileDescriptor lock_port(int port) {
  FileDescriptor socket(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  if (!socket) return {};
  const std::string name = "nextview-port-" + std::to_string(port);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::copy(name.begin(), name.end(), address.sun_path + 1);  // a leading 0: no file
  const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size());
  if (::bind(socket.get(), reinterpret_cast<const sockaddr*>(&address), size) != 0) return {};
  return socket;
}

}  // namespace

PortLock PortLock::acquire(int first, int last) {
  const std::set<int> bound = bound_udp_ports();
  for (int port = first; port <= last; ++port) {
    if (bound.contains(port)) continue;
    FileDescriptor socket = lock_port(port);
    if (socket) return {port, std::move(socket)};
  }
  throw NoFreePort("no free UDP port from " + std::to_string(first) + " to " +
                   std::to_string(last) +
                   ": end other runs (ss -ulpn shows who holds them), or name one with "
                   "--lcm-url=udpm://239.255.76.67:PORT?ttl=0");
}

std::string PortLock::lcm_url() const {
  return "udpm://239.255.76.67:" + std::to_string(port_) + "?ttl=0&recv_buf_size=4194304";
}

}  // namespace nextview

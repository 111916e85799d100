#include "lcmtypes/bus_probe.h"

#include <netdb.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <memory>
#include <string_view>

#include "lcmtypes/multicast_probe.h"
#include "lcmtypes/transport.h"

namespace nextview {
namespace {

constexpr std::string_view kTcp = "tcpq://";

struct Server {
  std::string host = "127.0.0.1";
  std::string port = "7700";  // LCM's own defaults
};

// tcpq://[host[:port]]
Server server_of(const std::string& url) {
  Server server;
  const std::string place = url.substr(kTcp.size());
  const std::size_t colon = place.find(':');
  if (colon != std::string::npos) server.port = place.substr(colon + 1);
  if (colon != 0 && !place.empty()) server.host = place.substr(0, colon);
  return server;
}

/// @return why no connection comes about; empty when one does
std::string why_unreachable(const Server& server) {
  addrinfo wanted{};
  wanted.ai_family = AF_INET;
  wanted.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  if (const int error = ::getaddrinfo(server.host.c_str(), server.port.c_str(), &wanted, &found)) {
    return ::gai_strerror(error);
  }
  const std::unique_ptr<addrinfo, void (*)(addrinfo*)> address(found, ::freeaddrinfo);
  const int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const bool connected =
      socket >= 0 && ::connect(socket, address->ai_addr, address->ai_addrlen) == 0;
  std::string why = connected ? "" : std::strerror(errno);
  if (socket >= 0) ::close(socket);
  return why;
}

void probe_server(const std::string& url) {
  const Server server = server_of(url);
  const std::string why = why_unreachable(server);
  if (why.empty()) return;
  throw BusError("LCM URL '" + url + "': no LCM server answers at " + server.host + ":" +
                 server.port + ": " + why +
                 ". Start one (java -cp lcm.jar lcm.lcm.TCPService PORT), or leave --lcm-url out");
}

}  // namespace

void probe_bus(const std::string& lcm_url) {
  if (lcm_url.empty() || lcm_url.starts_with("udpm://")) return probe_multicast(lcm_url);
  if (lcm_url.starts_with(kTcp)) return probe_server(lcm_url);
  throw BusError("LCM URL '" + lcm_url +
                 "' leads to no other process: name one like udpm://239.255.76.67:7667?ttl=0");
}

}  // namespace nextview

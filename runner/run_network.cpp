#include "runner/run_network.h"

#include <arpa/inet.h>
#include <sys/socket.h>

#include <cstdlib>

#include "runner/private_network.h"
#include "runner/run_setup.h"
#include "viewer/page_port.h"

namespace nextview {
namespace {

/// Whether others than the run's own processes may have been told where to meet.
bool expects_others(const RunOptions& options) {
  return !options.lcm_url.empty() || std::getenv("LCM_DEFAULT_URL") != nullptr ||
         !options.without.empty() || !options.elsewhere.empty();
}

/// @return nothing when the port cannot be had
FileDescriptor listen_on_loopback(std::uint16_t port) {
  FileDescriptor socket(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  const int yes = 1;
  ::setsockopt(socket.get(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  sockaddr_in here{};
  here.sin_family = AF_INET;
  here.sin_port = htons(port);
  here.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (::bind(socket.get(), reinterpret_cast<const sockaddr*>(&here), sizeof here) != 0 ||
      ::listen(socket.get(), SOMAXCONN) != 0) {
    return {};
  }
  return socket;
}

FileDescriptor listen_for_pages() {
  FileDescriptor socket = listen_on_loopback(kPagePort);
  if (!socket) socket = listen_on_loopback(0);
  if (!socket) throw SetupError("--view: no port of 127.0.0.1 can be had for its page");
  return socket;
}

}  // namespace

RunNetwork enter_network(const RunOptions& options) {
  RunNetwork network;
  if (!options.own_network.value_or(!expects_others(options))) return network;
  if (options.view) network.page = listen_for_pages();
  const std::string why_not = enter_private_network();
  network.own = why_not.empty();
  if (network.own) return network;
  network.page.reset();
  if (options.own_network) {
    throw SetupError("--private: there can be no network of its own here (" + why_not +
                     "): leave it out");
  }
  network.note =
      "others on this machine can speak on the run's bus, and the recorder hears the "
      "network: there can be no network of its own here (" +
      why_not + ")";
  return network;
}

std::optional<RunKey> run_key_of(const RunOptions& options) {
  if (options.key_file.empty()) return std::nullopt;
  return RunKey::read(options.key_file);
}

}  // namespace nextview

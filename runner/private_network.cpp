#include "runner/private_network.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <net/if.h>
#include <net/route.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>

#include "runner/file_descriptor.h"

namespace nextview {
namespace {

bool write_file(const char* file, const std::string& text) {
  std::ofstream out(file);
  out << text << std::flush;
  return out.good();
}

/// Who may not make a network may make one as the owner of a user namespace, in which he stays who
/// he is.
bool unshare_as_anybody() {
  const std::string user = std::to_string(::getuid());
  const std::string group = std::to_string(::getgid());
  if (::unshare(CLONE_NEWUSER | CLONE_NEWNET) != 0) return false;
  write_file("/proc/self/setgroups", "deny");
  return write_file("/proc/self/uid_map", user + " " + user + " 1") &&
         write_file("/proc/self/gid_map", group + " " + group + " 1");
}

void put_address(sockaddr& where, const char* dotted) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  ::inet_pton(AF_INET, dotted, &address.sin_addr);
  std::memcpy(&where, &address, sizeof address);
}

/// As "ip link set lo up; ip route add 224.0.0.0/4 dev lo" does.
bool set_up_loopback() {
  const FileDescriptor socket(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  if (!socket) return false;
  ifreq loopback{};
  std::strcpy(loopback.ifr_name, "lo");
  if (::ioctl(socket.get(), SIOCGIFFLAGS, &loopback) != 0) return false;
  loopback.ifr_flags = static_cast<short>(loopback.ifr_flags | IFF_UP | IFF_RUNNING);
  if (::ioctl(socket.get(), SIOCSIFFLAGS, &loopback) != 0) return false;
  rtentry route{};
  put_address(route.rt_dst, "224.0.0.0");
  put_address(route.rt_genmask, "240.0.0.0");
  route.rt_flags = RTF_UP;
  route.rt_dev = loopback.ifr_name;
  return ::ioctl(socket.get(), SIOCADDRT, &route) == 0;
}

}  // namespace

std::string enter_private_network() {
  const FileDescriptor before(::open("/proc/self/ns/net", O_RDONLY | O_CLOEXEC));
  if (::unshare(CLONE_NEWNET) != 0 && !unshare_as_anybody()) return std::strerror(errno);
  if (set_up_loopback()) return {};
  std::string why = std::string("its loopback: ") + std::strerror(errno);
  ::setns(before.get(), CLONE_NEWNET);
  return why;
}

std::string why_no_private_network() {
  const pid_t child = ::fork();
  if (child < 0) return std::strerror(errno);
  if (child == 0) ::_exit(enter_private_network().empty() ? 0 : std::max(errno, 1));
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (!WIFEXITED(status)) return "it cannot be tried";
  return WEXITSTATUS(status) == 0 ? std::string() : std::strerror(WEXITSTATUS(status));
}

std::string command_to_join_network_of(long pid) {
  const std::string process = std::to_string(pid);
  const bool root = ::geteuid() == 0;
  return "nsenter --target " + process + (root ? "" : " --user --preserve-credentials") + " --net";
}

}  // namespace nextview

// Preloaded into all programs of a run, the recorder included: of the datagrams that come, some are
// lost, some come twice and some are overtaken by the next, by a seeded dice of each program's own.
//
//   NEXTVIEW_FAULTS="LOST REPEATED OVERTAKEN SEED"   shares from 0 to 1, and a number
#include <dlfcn.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <optional>
#include <random>
#include <sstream>
#include <string>
#include <vector>

namespace {

struct Datagram {
  int socket;
  std::vector<char> bytes;
};

class Faults {
 public:
  Faults() {
    const char* given = std::getenv("NEXTVIEW_FAULTS");
    unsigned seed = 0;
    std::istringstream(given == nullptr ? "" : given) >> lost_ >> repeated_ >> overtaken_ >> seed;
    const std::string program = program_invocation_short_name;
    std::seed_seq mixed(program.begin(), program.end());
    dice_.seed(mixed);
    dice_.discard(1000 * seed);
  }

  bool loses() { return falls_below(lost_); }
  bool repeats() { return falls_below(repeated_); }
  bool delays() { return falls_below(overtaken_); }

  std::mutex mutex;
  std::optional<Datagram> held;  // comes once more, or late

 private:
  bool falls_below(double share) { return share > 0.0 && share_(dice_) < share; }

  double lost_ = 0.0;
  double repeated_ = 0.0;
  double overtaken_ = 0.0;
  std::mt19937 dice_;
  std::uniform_real_distribution<double> share_;
};

Faults& faults() {
  static Faults the_faults;
  return the_faults;
}

bool carries_datagrams(int socket) {
  int domain = 0;
  int type = 0;
  socklen_t size = sizeof(int);
  return ::getsockopt(socket, SOL_SOCKET, SO_DOMAIN, &domain, &size) == 0 && domain == AF_INET &&
         ::getsockopt(socket, SOL_SOCKET, SO_TYPE, &type, &size) == 0 && type == SOCK_DGRAM;
}

std::vector<char> bytes_of(const msghdr& message, ssize_t size) {
  std::vector<char> bytes;
  for (std::size_t i = 0; i < message.msg_iovlen; ++i) {
    const iovec& piece = message.msg_iov[i];
    const auto left = static_cast<std::size_t>(size) - bytes.size();
    const auto* begin = static_cast<const char*>(piece.iov_base);
    bytes.insert(bytes.end(), begin, begin + std::min(piece.iov_len, left));
  }
  return bytes;
}

ssize_t put_into(msghdr& message, const std::vector<char>& bytes) {
  std::size_t put = 0;
  for (std::size_t i = 0; i < message.msg_iovlen && put < bytes.size(); ++i) {
    const iovec& piece = message.msg_iov[i];
    const std::size_t size = std::min(piece.iov_len, bytes.size() - put);
    std::memcpy(piece.iov_base, bytes.data() + put, size);
    put += size;
  }
  message.msg_controllen = 0;
  message.msg_flags = put < bytes.size() ? MSG_TRUNC : 0;
  return static_cast<ssize_t>(put);
}

/// One datagram as the network would have brought it; an empty one, which no reader minds, in the
/// place of one that does not come.
ssize_t receive(int socket, msghdr* message, int flags) {
  static const auto really = reinterpret_cast<decltype(&recvmsg)>(::dlsym(RTLD_NEXT, "recvmsg"));
  if ((flags & MSG_PEEK) != 0 || !carries_datagrams(socket)) return really(socket, message, flags);
  Faults& fault = faults();
  {
    const std::scoped_lock lock(fault.mutex);
    if (fault.held && fault.held->socket == socket) {
      const Datagram held = *std::move(fault.held);
      fault.held.reset();
      return put_into(*message, held.bytes);
    }
  }
  const ssize_t size = really(socket, message, flags);
  if (size <= 0) return size;
  const std::scoped_lock lock(fault.mutex);
  const auto nothing = [message] {
    message->msg_controllen = 0;
    return ssize_t{0};
  };
  if (fault.loses()) return nothing();
  const bool delays = fault.delays();
  if (delays || fault.repeats()) fault.held = Datagram{socket, bytes_of(*message, size)};
  return delays ? nothing() : size;
}

}  // namespace

// LCM receives by this call.
extern "C" ssize_t recvmsg(int socket, msghdr* message, int flags) {
  return receive(socket, message, flags);
}

// The probe of the bus by this one.
extern "C" ssize_t recv(int socket, void* buffer, std::size_t size, int flags) {
  iovec piece{buffer, size};
  msghdr message{};
  message.msg_iov = &piece;
  message.msg_iovlen = 1;
  return receive(socket, &message, flags);
}

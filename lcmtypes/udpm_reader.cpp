#include "lcmtypes/udpm_reader.h"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <poll.h>
#include <signal.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <deque>
#include <mutex>
#include <set>
#include <system_error>
#include <thread>
#include <utility>

#include "lcmtypes/lcm_datagram.h"
#include "lcmtypes/transport.h"

namespace nextview {
namespace {

using Clock = std::chrono::steady_clock;

/// The IPv4 addresses of this machine, in network order, as they were when last looked at.
class OwnAddresses {
 public:
  bool contain(in_addr address) {
    // Both the kernel takes from this machine only; the second is how one speaks whose only network
    // is the loopback.
    if (ntohl(address.s_addr) >> 24 == 127 || address.s_addr == INADDR_ANY) return true;
    if (addresses_.contains(address.s_addr)) return true;
    // One that is new, or a stranger, of whom there may be many.
    constexpr std::chrono::seconds kOften{1};
    const auto now = Clock::now();
    if (looked_ && now - *looked_ < kOften) return false;
    looked_ = now;
    look();
    return addresses_.contains(address.s_addr);
  }

 private:
  void look() {
    ifaddrs* first = nullptr;
    if (getifaddrs(&first) != 0) return;
    addresses_.clear();
    for (const ifaddrs* one = first; one != nullptr; one = one->ifa_next) {
      if (one->ifa_addr == nullptr || one->ifa_addr->sa_family != AF_INET) continue;
      addresses_.insert(reinterpret_cast<const sockaddr_in*>(one->ifa_addr)->sin_addr.s_addr);
    }
    freeifaddrs(first);
  }

  std::set<in_addr_t> addresses_;
  std::optional<Clock::time_point> looked_;
};

/// Tells one thread that another has something for it.
class Bell {
 public:
  Bell() : fd_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
    if (fd_ < 0) throw std::system_error(errno, std::generic_category(), "eventfd");
  }
  Bell(const Bell&) = delete;
  Bell& operator=(const Bell&) = delete;
  ~Bell() { close(fd_); }
  int fd() const { return fd_; }
  void ring() { eventfd_write(fd_, 1); }
  void hush() {
    eventfd_t rung = 0;
    eventfd_read(fd_, &rung);
  }

 private:
  int fd_;
};

/// For as long as a thread is started, which inherits it: signals are the owner's to take.
class SignalsBlocked {
 public:
  SignalsBlocked() {
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before_);
  }
  SignalsBlocked(const SignalsBlocked&) = delete;
  SignalsBlocked& operator=(const SignalsBlocked&) = delete;
  ~SignalsBlocked() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }

 private:
  sigset_t before_;
};

/// What a message that waits takes of kMostWaiting.
std::size_t room_of(std::size_t message_bytes) {
  constexpr std::size_t kOfTheQueue = 128;
  return message_bytes + kOfTheQueue;
}

}  // namespace

struct UdpmReader::Shared {
  explicit Shared(const UdpmPlace& where)
      : own_only(where.ttl == 0), socket(where), thread([this] { read_on(); }) {}
  ~Shared() {
    ended = true;
    stop.ring();
    thread.join();
  }

  void read_on();
  /// False when there is nothing more to read.
  bool read_one(std::vector<std::uint8_t>& buffer);
  void refuse(std::string_view reason);
  void take(const LcmDatagram& datagram);

  const bool own_only;
  UdpmSocket socket;
  OwnAddresses own;
  sockaddr_in from{};  // who sent the last datagram
  std::atomic<bool> ended = false;
  std::atomic<bool> any_refused = false;
  Bell stop;
  Bell arrived;

  std::mutex mutex;  // of all that follows
  std::set<std::string, std::less<>> channels;
  std::deque<Message> waiting;
  std::size_t waiting_bytes = 0;
  std::map<std::string, std::int64_t> refused;
  int error = 0;

  std::thread thread;  // last: it uses the others
};

void UdpmReader::Shared::read_on() {
  std::vector<std::uint8_t> buffer(1 << 16);
  while (!ended) {
    std::array<pollfd, 2> ready{{{socket.fd(), POLLIN, 0}, {stop.fd(), POLLIN, 0}}};
    if (poll(ready.data(), ready.size(), -1) < 0 && errno != EINTR) break;
    while (!ended && read_one(buffer)) {
    }
    const std::lock_guard lock(mutex);
    if (error != 0) break;
  }
  arrived.ring();
}

bool UdpmReader::Shared::read_one(std::vector<std::uint8_t>& buffer) {
  iovec piece{buffer.data(), buffer.size()};
  msghdr header{};
  header.msg_name = &from;
  header.msg_namelen = sizeof from;
  header.msg_iov = &piece;
  header.msg_iovlen = 1;
  const ssize_t size = recvmsg(socket.fd(), &header, MSG_DONTWAIT);
  if (size < 0) {
    if (errno == EINTR) return true;
    if (errno == EAGAIN || errno == EWOULDBLOCK) return false;
    const std::lock_guard lock(mutex);
    error = errno;
    return false;
  }
  if (size < 8) return true;  // somebody's test of the network, as multicast_probe's is
  if (own_only && !own.contain(from.sin_addr)) {
    refuse("from another machine, though nothing is sent to any (ttl=0)");
    return true;
  }
  const LcmDatagram datagram = read_lcm_datagram({buffer.data(), static_cast<std::size_t>(size)});
  if (datagram.refusal.empty()) {
    take(datagram);
  } else {
    refuse(datagram.refusal);
  }
  return true;
}

void UdpmReader::Shared::refuse(std::string_view reason) {
  const std::lock_guard lock(mutex);
  ++refused[std::string(reason)];
  any_refused = true;
}

void UdpmReader::Shared::take(const LcmDatagram& datagram) {
  const std::lock_guard lock(mutex);
  if (!channels.contains(datagram.channel)) return;
  const std::size_t bytes = room_of(datagram.message.size());
  if (waiting_bytes + bytes > kMostWaiting) {
    ++refused["more than can be kept until it is looked at"];
    any_refused = true;
    return;
  }
  waiting_bytes += bytes;
  waiting.push_back(
      {std::string(datagram.channel), {datagram.message.begin(), datagram.message.end()}});
  if (waiting.size() == 1) arrived.ring();
}

UdpmReader::UdpmReader(const UdpmPlace& place) {
  const SignalsBlocked in_the_thread;
  shared_ = std::make_unique<Shared>(place);
}

UdpmReader::~UdpmReader() = default;

void UdpmReader::listen_to(std::string_view channel) {
  const std::lock_guard lock(shared_->mutex);
  shared_->channels.emplace(channel);
}

std::optional<UdpmReader::Message> UdpmReader::next(std::chrono::milliseconds timeout) {
  const auto take_first = [this]() -> std::optional<Message> {
    const std::lock_guard lock(shared_->mutex);
    if (shared_->waiting.empty()) {
      if (shared_->error != 0) {
        throw BusError("LCM has stopped receiving: " +
                       std::generic_category().message(shared_->error));
      }
      shared_->arrived.hush();
      return std::nullopt;
    }
    Message message = std::move(shared_->waiting.front());
    shared_->waiting.pop_front();
    shared_->waiting_bytes -= room_of(message.bytes.size());
    return message;
  };
  if (auto message = take_first()) return message;
  pollfd ready{shared_->arrived.fd(), POLLIN, 0};
  // A wait that would end the number of milliseconds is one without an end.
  constexpr std::int64_t kLongest = 1'000'000'000;
  const auto wait = static_cast<int>(std::clamp<std::int64_t>(timeout.count(), 0, kLongest));
  if (poll(&ready, 1, wait) <= 0) return std::nullopt;
  return take_first();
}

std::map<std::string, std::int64_t> UdpmReader::take_refused() {
  if (!shared_->any_refused) return {};
  const std::lock_guard lock(shared_->mutex);
  shared_->any_refused = false;
  return std::exchange(shared_->refused, {});
}

}  // namespace nextview

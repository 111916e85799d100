#include "lcmtypes/lcm_transport.h"

#include <poll.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <lcm/lcm-cpp.hpp>
#include <list>
#include <map>
#include <optional>
#include <stdexcept>
#include <thread>
#include <utility>

#include "lcmtypes/bus_probe.h"
#include "lcmtypes/channels.h"
#include "lcmtypes/open_files.h"
#include "lcmtypes/udpm_reader.h"

namespace nextview {
namespace {

using Clock = std::chrono::steady_clock;

/// Lets through a burst, then a steady stream: every message costs time, paid back at the pace of
/// the clock, and the debt must stay within the burst.
class Pacer {
 public:
  void wait_for(std::size_t bytes) {
    // lcm-logger keeps about 30 messages and a socket 200 KB: half of either is a safe burst.
    constexpr double kMessagesPerBurst = 16;
    constexpr double kMessagesPerSecond = 2000;
    constexpr double kBytesPerBurst = 100e3;
    constexpr double kBytesPerSecond = 40e6;
    const auto now = Clock::now();
    messages_until_ = std::max(messages_until_, now) + seconds(1 / kMessagesPerSecond);
    bytes_until_ =
        std::max(bytes_until_, now) + seconds(static_cast<double>(bytes) / kBytesPerSecond);
    const auto start = std::max(messages_until_ - seconds(kMessagesPerBurst / kMessagesPerSecond),
                                bytes_until_ - seconds(kBytesPerBurst / kBytesPerSecond));
    if (start > now) std::this_thread::sleep_until(start);
  }

 private:
  static Clock::duration seconds(double value) {
    return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(value));
  }
  Clock::time_point messages_until_;
  Clock::time_point bytes_until_;
};

// Above this LCM cuts a message, its channel's name counted, into fragments, which liblcm up
// to 1.5.2 puts together without care (README, Limits). So nobody ever sends one.
constexpr std::size_t kLcmUnfragmentedBytes = 65499;
constexpr std::size_t kLongestChannelName = 63;
static_assert(kMaxMessageBytes + kLongestChannelName + 1 < kLcmUnfragmentedBytes);

std::string resolve_url(const std::string& lcm_url) {
  if (!lcm_url.empty()) return lcm_url;
  const char* from_environment = std::getenv("LCM_DEFAULT_URL");
  return from_environment == nullptr ? "" : from_environment;
}

}  // namespace

struct LcmTransport::Connection {
  struct Subscriber {
    Connection* connection;
    Receiver receiver;
  };

  explicit Connection(const std::string& url) : lcm(url) {}

  // Called from C, which an exception must not cross.
  static void receive(const lcm::ReceiveBuffer* buffer, const std::string& /*channel*/,
                      Subscriber* subscriber) {
    try {
      subscriber->receiver({static_cast<const std::uint8_t*>(buffer->data), buffer->data_size});
    } catch (...) {
      if (!subscriber->connection->thrown) {
        subscriber->connection->thrown = std::current_exception();
      }
    }
  }

  /// By liblcm, of providers other than udpm.
  void subscribe(const std::string& channel, Subscriber& subscriber) {
    lcm::Subscription* subscription =
        lcm.subscribeFunction(channel, &Connection::receive, &subscriber);
    // The default drops all but the last 30 messages that wait, without a word.
    if (subscription == nullptr || subscription->setQueueCapacity(0) != 0) {
      throw BusError("LCM cannot subscribe to " + channel);
    }
  }
  bool handle(std::chrono::milliseconds timeout) {
    pollfd ready{lcm.getFileno(), POLLIN, 0};
    const int count = poll(&ready, 1, static_cast<int>(std::max<std::int64_t>(timeout.count(), 0)));
    if (count == 0 || (count < 0 && errno == EINTR)) return false;
    if (count < 0 || lcm.handle() != 0) throw BusError("LCM has stopped receiving");
    if (thrown) std::rethrow_exception(std::exchange(thrown, nullptr));
    return true;
  }

  /// What has come over udpm.
  bool handle_read(std::chrono::milliseconds timeout) {
    const auto message = reader->next(timeout);
    if (!message) return false;
    const auto [first, last] = by_channel.equal_range(message->channel);
    for (auto subscriber = first; subscriber != last; ++subscriber) {
      subscriber->second->receiver(message->bytes);
    }
    return true;
  }

  Pacer pacer;
  std::exception_ptr thrown;
  std::list<Subscriber> subscribers;  // never moved: LCM holds pointers
  std::multimap<std::string, Subscriber*, std::less<>> by_channel;
  std::optional<UdpmReader> reader;
  lcm::LCM lcm;  // last, so that it goes first
};

LcmTransport::LcmTransport(const std::string& lcm_url) {
  const std::string url = resolve_url(lcm_url);
  // With too few LCM crashes.
  if (const auto why = too_few_open_files(kOpenFilesOfProcess); !why.empty()) throw BusError(why);
  probe_bus(url);
  connection_ = std::make_unique<Connection>(url);
  if (!connection_->lcm.good()) throw BusError("LCM cannot be opened with URL '" + url + "'");
  if (is_udpm_url(url)) connection_->reader.emplace(parse_udpm_url(url));
}

LcmTransport::~LcmTransport() = default;

void LcmTransport::publish(std::string_view channel, std::span<const std::uint8_t> bytes) {
  if (bytes.size() > kMaxMessageBytes) {
    throw std::logic_error(std::to_string(bytes.size()) + " bytes on " + std::string(channel) +
                           ": more than a message may have");
  }
  connection_->pacer.wait_for(bytes.size());
  if (connection_->lcm.publish(std::string(channel), bytes.data(),
                               static_cast<unsigned int>(bytes.size())) != 0) {
    throw BusError("LCM cannot publish on " + std::string(channel) + ": " + std::strerror(errno));
  }
}

void LcmTransport::subscribe(std::string_view channel, Receiver receiver) {
  connection_->subscribers.push_back({connection_.get(), std::move(receiver)});
  Connection::Subscriber& subscriber = connection_->subscribers.back();
  if (!connection_->reader) return connection_->subscribe(std::string(channel), subscriber);
  connection_->by_channel.emplace(channel, &subscriber);
  connection_->reader->listen_to(channel);
}

bool LcmTransport::handle(std::chrono::milliseconds timeout) {
  return connection_->reader ? connection_->handle_read(timeout) : connection_->handle(timeout);
}

std::map<std::string, std::int64_t> LcmTransport::take_refused() {
  if (!connection_->reader) return {};
  return connection_->reader->take_refused();
}

}  // namespace nextview

// Datagrams as they come to a process of a run, one after the other: for each a byte for its
// channel, two for its length, and its bytes, without the fingerprint. They are delivered, kept as
// a run keeps them, and answered.
#include <algorithm>
#include <map>
#include <memory>
#include <vector>

#include "lcmtypes/bus.h"
#include "logger/run_record.h"
#include "tests/fuzz/fuzz_input.h"

namespace nextview {
namespace {

constexpr std::int64_t kRun = 7;

/// Hands over what it is given, and sends nothing.
class FedTransport : public Transport {
 public:
  using Receivers = std::multimap<std::string, Receiver, std::less<>>;
  explicit FedTransport(Receivers& receivers) : receivers_(receivers) {}
  void publish(std::string_view, std::span<const std::uint8_t> bytes) override {
    demand(bytes.size() <= kMaxMessageBytes, "nothing larger than a message is sent");
  }
  void subscribe(std::string_view channel, Receiver receiver) override {
    receivers_.emplace(channel, std::move(receiver));
  }
  bool handle(std::chrono::milliseconds) override { return false; }

 private:
  Receivers& receivers_;
};

struct Datagram {
  std::size_t channel = 0;
  FuzzInput bytes;
};

std::optional<Datagram> take_datagram(FuzzInput& input) {
  constexpr std::size_t kHead = 3;
  if (input.size() < kHead) return std::nullopt;
  const std::size_t length =
      std::min<std::size_t>(input[1] * 256U + input[2], input.size() - kHead);
  const Datagram datagram{input[0] % AllMessages::size, input.subspan(kHead, length)};
  input = input.subspan(kHead + length);
  return datagram;
}

template <class Message>
std::vector<std::uint8_t> with_fingerprint(FuzzInput bytes) {
  std::vector<std::uint8_t> whole;
  const auto fingerprint = static_cast<std::uint64_t>(Message::getHash());
  for (int shift = 56; shift >= 0; shift -= 8) {
    whole.push_back(static_cast<std::uint8_t>(fingerprint >> shift & 0xFF));
  }
  whole.insert(whole.end(), bytes.begin(), bytes.end());
  return whole;
}

}  // namespace
}  // namespace nextview

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace nextview;
  FedTransport::Receivers receivers;
  Bus bus(std::make_unique<FedTransport>(receivers), kRun, "mapper");
  RunRecord record(RangeImages::Keep);
  for_each_channel([&]<class Message>() {
    // What the bus itself takes in.
    constexpr bool bus_s_own = std::is_same_v<Message, request_t> ||
                               std::is_same_v<Message, parts_request_t> ||
                               std::is_same_v<Message, recorded_t>;
    if constexpr (!bus_s_own) {
      bus.on<Message>([&](const Message& message) {
        if constexpr (requires { record.add(message); }) record.add(message);
      });
    }
  });
  bus.on_missing([](const request_t&) {});
  status_t status{};
  status.role = "mapper";
  status.program_version = "0";
  bus.publish(status);
  FuzzInput input(bytes, size);
  std::int64_t fed = 0;
  while (const auto datagram = take_datagram(input)) {
    std::size_t channel = datagram->channel;
    for_each_channel([&]<class Message>() {
      if (channel-- != 0) return;
      const auto [first, last] = receivers.equal_range(Channel<Message>::name);
      const auto whole = with_fingerprint<Message>(datagram->bytes);
      for (auto receiver = first; receiver != last; ++receiver) receiver->second(whole);
    });
    ++fed;
  }
  const BusCounters& counters = bus.counters();
  demand(counters.delivered + counters.foreign + counters.repeated + counters.refused <= fed,
         "every datagram counts once at most");
  (void)record.missing();
  (void)record.held_in_part();
  return 0;
}

#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

namespace nextview {

/// The bus cannot be used; what() says why and what to type.
class BusError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Carries bytes on named channels to everybody, the sender included; may lose, repeat and reorder
/// them. LcmTransport in a run; tests have their own that loses on purpose.
class Transport {
 public:
  using Receiver = std::function<void(std::span<const std::uint8_t>)>;

  virtual ~Transport() = default;
  virtual void publish(std::string_view channel, std::span<const std::uint8_t> bytes) = 0;
  virtual void subscribe(std::string_view channel, Receiver receiver) = 0;
  /// Waits for one message and hands it to its receivers, from this thread; false when none came.
  /// What a receiver throws comes out here.
  virtual bool handle(std::chrono::milliseconds timeout) = 0;
  /// What came since the last call and was refused unseen, as it can be no message: how often, by
  /// the reason.
  virtual std::map<std::string, std::int64_t> take_refused() { return {}; }
};

}  // namespace nextview

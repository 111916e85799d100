#pragma once

#include <memory>
#include <string>

#include "lcmtypes/transport.h"

namespace nextview {

/// LCM, with what a run needs around it: the network is probed before LCM touches it, queues have
/// no cap, and bursts are paced so that receivers (lcm-logger among them) can follow. What comes
/// over udpm:// liblcm does not see: UdpmReader reads it.
class LcmTransport : public Transport {
 public:
  /// @throws BusError when the bus does not work here, saying what to type
  explicit LcmTransport(const std::string& lcm_url);
  ~LcmTransport() override;
  void publish(std::string_view channel, std::span<const std::uint8_t> bytes) override;
  void subscribe(std::string_view channel, Receiver receiver) override;
  bool handle(std::chrono::milliseconds timeout) override;
  std::map<std::string, std::int64_t> take_refused() override;

 private:
  struct Connection;  // hides LCM's headers
  std::unique_ptr<Connection> connection_;
};

}  // namespace nextview

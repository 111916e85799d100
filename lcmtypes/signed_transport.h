#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "lcmtypes/run_key.h"
#include "lcmtypes/transport.h"

namespace nextview {

/// Signs what is published, and hands on only what bears a signature of the same key, without it.
/// The rest is refused before anything of it is decoded.
class SignedTransport : public Transport {
 public:
  SignedTransport(std::unique_ptr<Transport> transport, const RunKey& key);

  void publish(std::string_view channel, std::span<const std::uint8_t> bytes) override;
  void subscribe(std::string_view channel, Receiver receiver) override;
  bool handle(std::chrono::milliseconds timeout) override { return transport_->handle(timeout); }
  std::map<std::string, std::int64_t> take_refused() override;

 private:
  std::unique_ptr<Transport> transport_;
  RunKey key_;
  std::map<std::string, std::int64_t> refused_;  // by the reason
};

/// The way to others over LCM.
/// @param key of the run; nothing: nothing is signed
/// @throws BusError as LcmTransport does
std::unique_ptr<Transport> transport_on(const std::string& lcm_url,
                                        const std::optional<RunKey>& key);

}  // namespace nextview

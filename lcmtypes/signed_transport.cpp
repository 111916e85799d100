#include "lcmtypes/signed_transport.h"

#include <utility>
#include <vector>

#include "lcmtypes/lcm_transport.h"

namespace nextview {

SignedTransport::SignedTransport(std::unique_ptr<Transport> transport, const RunKey& key)
    : transport_(std::move(transport)), key_(key) {}

void SignedTransport::publish(std::string_view channel, std::span<const std::uint8_t> bytes) {
  std::vector<std::uint8_t> signed_bytes(bytes.begin(), bytes.end());
  key_.sign(channel, signed_bytes);
  transport_->publish(channel, signed_bytes);
}

void SignedTransport::subscribe(std::string_view channel, Receiver receiver) {
  transport_->subscribe(
      channel, [this, name = std::string(channel),
                receiver = std::move(receiver)](std::span<const std::uint8_t> bytes) {
        if (key_.has_signed(name, bytes)) {
          receiver(bytes.first(bytes.size() - RunKey::kSignatureBytes));
        } else {
          ++refused_["on " + name + ", not signed by the run's key (--key-file), or altered"];
        }
      });
}

std::map<std::string, std::int64_t> SignedTransport::take_refused() {
  std::map<std::string, std::int64_t> refused = transport_->take_refused();
  for (const auto& [reason, count] : std::exchange(refused_, {})) refused[reason] += count;
  return refused;
}

std::unique_ptr<Transport> transport_on(const std::string& lcm_url,
                                        const std::optional<RunKey>& key) {
  auto transport = std::make_unique<LcmTransport>(lcm_url);
  if (!key) return transport;
  return std::make_unique<SignedTransport>(std::move(transport), *key);
}

}  // namespace nextview

#include "logger/signature.h"

#include "lcmtypes/decode.h"

namespace nextview {

Signature signature_of(std::string_view channel, std::span<const std::uint8_t> bytes,
                       const std::optional<RunKey>& key) {
  Signature signature = Signature::None;
  for_each_channel([&]<class Message>() {
    if (channel != Channel<Message>::name) return;
    if (key) {
      signature = key->has_signed(channel, bytes) ? Signature::Right : Signature::Wrong;
    } else if (bytes.size() > RunKey::kSignatureBytes && !wrong_layout<Message>(bytes).empty() &&
               wrong_layout<Message>(bytes.first(bytes.size() - RunKey::kSignatureBytes)).empty()) {
      signature = Signature::Unchecked;
    }
  });
  return signature;
}

}  // namespace nextview

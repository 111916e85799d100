// The bytes of a message, of the type that the first byte says: decode and check. What is taken is
// what was sent.
#include <algorithm>
#include <vector>

#include "lcmtypes/decode.h"
#include "tests/fuzz/fuzz_input.h"

namespace nextview {
namespace {

template <class Message>
void decode_one(FuzzInput input) {
  // The fingerprint is given: nobody finds one by chance.
  std::vector<std::uint8_t> bytes;
  const auto fingerprint = static_cast<std::uint64_t>(Message::getHash());
  for (int shift = 56; shift >= 0; shift -= 8) {
    bytes.push_back(static_cast<std::uint8_t>(fingerprint >> shift & 0xFF));
  }
  bytes.insert(bytes.end(), input.begin(), input.end());
  const Decoded<Message> decoded = decode_checked<Message>(bytes);
  demand(decoded.message.has_value() == decoded.reason.empty(), "a message, or a reason");
  if (!decoded.message) return;
  demand(encode(*decoded.message) == bytes, "a message is encoded as it came");
  (void)key_of(*decoded.message);
}

}  // namespace
}  // namespace nextview

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace nextview;
  if (size == 0) return 0;
  std::size_t type = bytes[0] % AllMessages::size;
  for_each_channel([&]<class Message>() {
    if (type-- == 0) decode_one<Message>(FuzzInput(bytes + 1, size - 1));
  });
  return 0;
}

// The generated code puts every number byte by byte. Compilers know that as one swap of its bytes
// and one store, but g++'s loop vectoriser, on at -O3, gets at it first and makes five times as
// much work of it; so it is off for this file (CMakeLists.txt). Flattened, because the linker would
// be free to take the generated functions from any other file.
#include <tuple>

#include "lcmtypes/decode.h"

namespace nextview {

template <class Message>
[[gnu::flatten]] std::vector<std::uint8_t> encode(const Message& message) {
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(message.getEncodedSize()));
  message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  return bytes;
}

namespace {

template <class... Messages>
constexpr auto encoders_of(TypeList<Messages...>) {
  return std::tuple(&encode<Messages>...);
}
// Makes the encoder of every type, here and nowhere else.
[[gnu::used]] constexpr auto kEncoders = encoders_of(AllMessages{});

}  // namespace
}  // namespace nextview

#include "lcmtypes/decode.h"

namespace nextview {
namespace {

// LCM is big-endian.
std::int64_t big_endian(std::span<const std::uint8_t> bytes) {
  std::uint64_t value = 0;
  for (const std::uint8_t byte : bytes) value = value << 8 | byte;
  return static_cast<std::int64_t>(value);
}

std::int64_t int32_at(std::span<const std::uint8_t> bytes, std::size_t offset) {
  return static_cast<std::int32_t>(big_endian(bytes.subspan(offset, 4)));
}

std::string wrong_size(std::size_t received, std::size_t expected) {
  return std::to_string(received) + " bytes where its lengths add up to " +
         std::to_string(expected);
}

}  // namespace

std::string check_layout(const MessageLayout& layout, std::span<const std::uint8_t> bytes) {
  if (bytes.size() < layout.smallest_bytes) {
    return std::to_string(bytes.size()) + " bytes, fewer than the " +
           std::to_string(layout.smallest_bytes) + " the type needs";
  }
  if (big_endian(bytes.first(8)) != layout.fingerprint) {
    return "fingerprint of another type or version";
  }

  std::size_t expected = layout.smallest_bytes;
  for (const LengthField& field : layout.lengths) {
    const std::int64_t length = int32_at(bytes, field.offset);
    if (length < 0) return "array length " + std::to_string(length);
    if (static_cast<std::size_t>(length) > bytes.size() / field.bytes_per_element) {
      return "array length " + std::to_string(length) + " in " + std::to_string(bytes.size()) +
             " bytes";
    }
    expected += static_cast<std::size_t>(length) * field.bytes_per_element;
  }
  if (layout.strings == 0) {
    return bytes.size() == expected ? "" : wrong_size(bytes.size(), expected);
  }

  // The strings stand side by side at the end: an int32 length that counts the closing NUL, then
  // the bytes.
  constexpr std::size_t kEmptyString = 5;
  const auto strings = static_cast<std::size_t>(layout.strings);
  std::size_t offset = expected - strings * kEmptyString;
  for (std::size_t i = 0; i < strings; ++i) {
    if (offset + 4 > bytes.size()) return "ends inside a string";
    const std::int64_t length = int32_at(bytes, offset);
    offset += 4;
    if (length < 1 || static_cast<std::size_t>(length) > bytes.size() - offset) {
      return "string length " + std::to_string(length) + " with " +
             std::to_string(bytes.size() - offset) + " bytes left";
    }
    const auto text = bytes.subspan(offset, static_cast<std::size_t>(length));
    for (std::size_t k = 0; k < text.size(); ++k) {
      if ((text[k] == 0) != (k + 1 == text.size())) return "string with its end in the wrong place";
    }
    offset += text.size();
  }
  return bytes.size() == offset ? "" : wrong_size(bytes.size(), offset);
}

}  // namespace nextview

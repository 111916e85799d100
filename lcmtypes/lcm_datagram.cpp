#include "lcmtypes/lcm_datagram.h"

#include <algorithm>

namespace nextview {

LcmDatagram read_lcm_datagram(std::span<const std::uint8_t> bytes) {
  constexpr std::size_t kHeaderBytes = 8;              // a magic number, then a sequence number
  constexpr std::uint32_t kWholeMessage = 0x4c433032;  // "LC02"
  constexpr std::uint32_t kFragment = 0x4c433033;      // "LC03"
  constexpr std::size_t kLongestChannel = 63;
  const auto refused = [](std::string_view why) { return LcmDatagram{{}, {}, why}; };
  if (bytes.size() < kHeaderBytes) return refused("too short for LCM");
  std::uint32_t magic = 0;
  for (const std::uint8_t byte : bytes.first(4)) magic = magic << 8 | byte;
  if (magic == kFragment) return refused("a fragment of a larger message, as nobody here sends");
  if (magic != kWholeMessage) return refused("no datagram of LCM");
  const auto rest = bytes.subspan(kHeaderBytes);
  const auto name = rest.first(std::min(rest.size(), kLongestChannel + 1));
  const auto end = std::find(name.begin(), name.end(), std::uint8_t{0});
  if (end == name.end()) return refused("a channel's name without an end");
  if (end == name.begin()) return refused("a channel without a name");
  const auto length = static_cast<std::size_t>(end - name.begin());
  return {{reinterpret_cast<const char*>(name.data()), length}, rest.subspan(length + 1), {}};
}

}  // namespace nextview

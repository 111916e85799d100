#include "lcmtypes/lcm_datagram.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace nextview {
namespace {

std::vector<std::uint8_t> datagram(std::string_view magic, const std::string& rest) {
  const std::string text = std::string(magic) + std::string(4, '\0') + rest;
  return {text.begin(), text.end()};
}

TEST(LcmDatagram, IsAChannelAndItsMessage) {
  const auto bytes = datagram("LC02", std::string("NEXTVIEW_GOAL\0abc", 17));
  const LcmDatagram read = read_lcm_datagram(bytes);
  EXPECT_EQ(read.refusal, "");
  EXPECT_EQ(read.channel, "NEXTVIEW_GOAL");
  EXPECT_EQ(std::string(read.message.begin(), read.message.end()), "abc");
}

TEST(LcmDatagram, MayHoldNothing) {
  const auto bytes = datagram("LC02", std::string("C\0", 2));
  EXPECT_EQ(read_lcm_datagram(bytes).channel, "C");
  EXPECT_TRUE(read_lcm_datagram(bytes).message.empty());
}

TEST(LcmDatagram, WithANameOf63LettersIsOne) {
  EXPECT_EQ(
      read_lcm_datagram(datagram("LC02", std::string(63, 'C') + std::string(1, '\0'))).refusal, "");
}

// Each would be a read or a write out of bounds to somebody who believes it.
TEST(LcmDatagram, IsRefusedForWhatItSaysOfItself) {
  const auto refusal = [](const std::vector<std::uint8_t>& bytes) {
    const LcmDatagram read = read_lcm_datagram(bytes);
    EXPECT_TRUE(read.channel.empty());
    EXPECT_TRUE(read.message.empty());
    return std::string(read.refusal);
  };
  EXPECT_EQ(refusal({}), "too short for LCM");
  EXPECT_EQ(refusal({'L', 'C', '0', '2', 0, 0, 0}), "too short for LCM");
  EXPECT_EQ(refusal(datagram("LC01", "C")), "no datagram of LCM");
  EXPECT_EQ(refusal(datagram("LC03", std::string(12, '\xff'))),
            "a fragment of a larger message, as nobody here sends");
  EXPECT_EQ(refusal(datagram("LC02", "")), "a channel's name without an end");
  EXPECT_EQ(refusal(datagram("LC02", "NEXTVIEW_GOAL")), "a channel's name without an end");
  EXPECT_EQ(refusal(datagram("LC02", std::string(64, 'C') + std::string(10, '\0'))),
            "a channel's name without an end");
  EXPECT_EQ(refusal(datagram("LC02", std::string("\0abc", 4))), "a channel without a name");
}

}  // namespace
}  // namespace nextview

#include "lcmtypes/decode.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <filesystem>
#include <iostream>
#include <limits>
#include <random>
#include <set>

#include "tests/lcmtypes/allocation_watch.h"
#include "tests/lcmtypes/examples.h"

namespace nextview {
namespace {

using Bytes = std::vector<std::uint8_t>;

void put_int32(Bytes& bytes, std::size_t offset, std::int32_t value) {
  const auto bits = static_cast<std::uint32_t>(value);
  for (std::size_t i = 0; i < 4; ++i) {
    bytes.at(offset + i) = static_cast<std::uint8_t>(bits >> (24 - 8 * i));
  }
}

std::int32_t int32_at(const Bytes& bytes, std::size_t offset) {
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < 4; ++i) bits = bits << 8 | bytes.at(offset + i);
  return static_cast<std::int32_t>(bits);
}

Bytes resized(const Bytes& bytes, std::size_t size) {
  Bytes result(size);
  std::copy_n(bytes.begin(), std::min(size, bytes.size()), result.begin());
  return result;
}

template <class Message>
std::string reason_for(const Bytes& bytes) {
  const Decoded<Message> decoded = decode_checked<Message>(bytes);
  EXPECT_EQ(decoded.message.has_value(), decoded.reason.empty());
  EXPECT_EQ(decoded.reason.find('\n'), std::string::npos);
  return decoded.reason;
}

template <class Message>
class EveryType : public testing::Test {};
template <class... Messages>
testing::Types<Messages...> test_types(TypeList<Messages...>);
using AllTypes = decltype(test_types(AllMessages{}));
TYPED_TEST_SUITE(EveryType, AllTypes);

TYPED_TEST(EveryType, SurvivesTheRoundTripUnchanged) {
  const Bytes bytes = encode(example<TypeParam>());
  const Decoded<TypeParam> decoded = decode_checked<TypeParam>(bytes);
  ASSERT_TRUE(decoded.message) << decoded.reason;
  EXPECT_EQ(encode(*decoded.message), bytes);
}

template <class Message>
Bytes generated_encoding(const Message& message) {
  Bytes bytes(static_cast<std::size_t>(message.getEncodedSize()));
  EXPECT_EQ(message.encode(bytes.data(), 0, static_cast<int>(bytes.size())),
            static_cast<int>(bytes.size()));
  return bytes;
}

TYPED_TEST(EveryType, IsEncodedAsTheGeneratedCodeDoes) {
  const auto message = example<TypeParam>();
  EXPECT_EQ(encode(message), generated_encoding(message));
}

TYPED_TEST(EveryType, IsRefusedWhenCutShortAnywhereOrTooLong) {
  const Bytes bytes = encode(example<TypeParam>());
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_NE(reason_for<TypeParam>(Bytes(bytes.begin(), bytes.begin() + static_cast<long>(size))),
              "")
        << size;
  }
  for (const std::size_t extra : {1U, 4U, 1000U}) {
    EXPECT_NE(reason_for<TypeParam>(resized(bytes, bytes.size() + extra)), "") << extra;
  }
}

TYPED_TEST(EveryType, IsRefusedAsAnyOtherType) {
  const Bytes bytes = encode(example<TypeParam>());
  int others = 0;
  for_each_channel([&]<class Other>() {
    if constexpr (!std::is_same_v<Other, TypeParam>) {
      EXPECT_NE(reason_for<Other>(bytes), "") << Channel<Other>::name;
      ++others;
    }
  });
  EXPECT_EQ(others, static_cast<int>(AllMessages::size) - 1);
}

TYPED_TEST(EveryType, IsRefusedWithAnyArrayLengthButItsOwn) {
  const Bytes bytes = encode(example<TypeParam>());
  for (const LengthField& field : Channel<TypeParam>::lengths) {
    for (const std::int32_t length :
         {std::numeric_limits<std::int32_t>::min(), -1, 0, 1, 5, 1000, 0x10000000, 0x20000000,
          0x40000000, std::numeric_limits<std::int32_t>::max()}) {
      if (length == int32_at(bytes, field.offset)) continue;
      Bytes wrong = bytes;
      put_int32(wrong, field.offset, length);
      EXPECT_NE(reason_for<TypeParam>(wrong), "") << "offset " << field.offset << " " << length;
    }
  }
}

TYPED_TEST(EveryType, IsRefusedWithAnyStringLengthButItsOwn) {
  if constexpr (Channel<TypeParam>::strings > 0) {
    const Bytes bytes = encode(example<TypeParam>());
    constexpr auto kStrings = static_cast<std::size_t>(Channel<TypeParam>::strings);
    std::size_t first = static_cast<std::size_t>(TypeParam{}.getEncodedSize()) - 5 * kStrings;
    for (const LengthField& field : Channel<TypeParam>::lengths) {
      first += static_cast<std::size_t>(int32_at(bytes, field.offset)) * field.bytes_per_element;
    }
    for (const std::int32_t length : {std::numeric_limits<std::int32_t>::min(), -1, 0, 100000,
                                      std::numeric_limits<std::int32_t>::max()}) {
      Bytes wrong = bytes;
      put_int32(wrong, first, length);
      EXPECT_NE(reason_for<TypeParam>(wrong), "") << length;
    }
  }
}

// What no decoder may do with any bytes: crash, throw, allocate out of proportion, or accept what
// does not mean itself.
TYPED_TEST(EveryType, MakesTheDecoderNeitherCrashNorAllocateWhateverItsBytes) {
  constexpr int kCases = 20000;
  constexpr std::array<std::int32_t, 8> kNastyLengths = {
      std::numeric_limits<std::int32_t>::min(),
      std::numeric_limits<std::int32_t>::max(),
      -1,
      0,
      1,
      0x20000000,
      0x7f800000,
      0x7ff80000};  // the last two begin an infinity and a NaN
  const Bytes original = encode(example<TypeParam>());
  std::mt19937_64 random(1);
  const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random() % n); };
  int accepted = 0;
  int refused = 0;
  watch_allocations();
  for (int i = 0; i < kCases; ++i) {
    Bytes bytes = original;
    switch (i % 4) {
      case 0:  // a bit or a few
        for (std::size_t flips = 1 + below(8); flips > 0; --flips) {
          bytes[below(bytes.size())] ^= static_cast<std::uint8_t>(1U << below(8));
        }
        break;
      case 1:  // a bit behind the fingerprint, so that it gets further
        bytes[8 + below(bytes.size() - 8)] ^= static_cast<std::uint8_t>(1U << below(8));
        break;
      case 2:  // four bytes that may be a length or the front of a number
        put_int32(bytes, 8 + below(bytes.size() - 12), kNastyLengths[below(kNastyLengths.size())]);
        break;
      default:  // another size and a byte
        bytes = resized(bytes, below(bytes.size() + 40));
        if (!bytes.empty()) bytes[below(bytes.size())] = static_cast<std::uint8_t>(random());
        break;
    }
    const Decoded<TypeParam> decoded = decode_checked<TypeParam>(bytes);
    if (decoded.message) {
      ++accepted;
      ASSERT_EQ(encode(*decoded.message), bytes) << "case " << i;
    } else {
      ++refused;
      ASSERT_NE(decoded.reason, "") << "case " << i;
    }
  }
  EXPECT_EQ(accepted + refused, kCases);
  EXPECT_GT(refused, kCases / 4);
  EXPECT_GT(accepted, 0);  // a bit of utime may be anything
  EXPECT_LE(largest_allocation(), 16 * (original.size() + 40) + 4096);
  std::cout << kCases << " mutations: " << accepted << " accepted, " << refused << " refused\n";
}

// Any bits, every infinity and NaN among them: encoding is not where a range is judged.
TEST(Encode, RangeImagesOfAnySizeAndBitsAsTheGeneratedCodeDoes) {
  std::mt19937_64 random(2);
  for (int pixels = 0; pixels < 200; ++pixels) {
    auto image = example<range_image_t>();
    image.columns = static_cast<std::int32_t>(random() % 50);
    image.rows = static_cast<std::int32_t>(random() % 50);
    image.pixels = pixels;
    image.entries = static_cast<std::int32_t>(random() % 50);
    for (auto* table : {&image.entry_sin, &image.entry_cos}) {
      table->clear();
      while (table->size() < 50) table->push_back(std::bit_cast<double>(random()));
    }
    image.range_m.clear();
    while (image.range_m.size() < static_cast<std::size_t>(pixels)) {
      image.range_m.push_back(std::bit_cast<float>(static_cast<std::uint32_t>(random())));
    }
    image.range_max_m = std::bit_cast<double>(random());
    EXPECT_EQ(encode(image), generated_encoding(image)) << pixels;
  }
}

TEST(Channels, HaveDistinctNamesAndFingerprints) {
  std::set<std::string_view> names;
  std::set<std::int64_t> fingerprints;
  for_each_channel([&]<class Message>() {
    names.insert(Channel<Message>::name);
    fingerprints.insert(Message::getHash());
  });
  EXPECT_EQ(names.size(), AllMessages::size);
  EXPECT_EQ(fingerprints.size(), AllMessages::size);
}

// Every .lcm file is a message of the list or a part of run_config_t: a type that somebody forgot
// would not be decoded, recorded or replayed, without a word.
TEST(Channels, AreThereForEveryTypeOfTheFolder) {
  std::set<std::string> listed;
  for_each_channel([&]<class Message>() { listed.insert(Message::getTypeName()); });
  std::set<std::string> defined;
  for (const auto& entry : std::filesystem::directory_iterator(NEXTVIEW_SOURCE_DIR "/lcmtypes")) {
    const std::string stem = entry.path().stem().string();
    if (entry.path().extension() != ".lcm") continue;
    const std::string type = stem.substr(std::string("nextview_").size());
    if (type != "run_config_t" && type.ends_with("_config_t")) continue;
    defined.insert(type);
  }
  EXPECT_EQ(listed, defined);
  EXPECT_EQ(defined.size(), AllMessages::size);
}

TEST(Decode, RefusesAStringThatEndsEarly) {
  Bytes bytes = encode(example<arrival_t>());
  *(bytes.end() - 5) = 0;
  EXPECT_NE(reason_for<arrival_t>(bytes), "");
}

}  // namespace
}  // namespace nextview

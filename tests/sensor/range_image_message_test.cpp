#include "sensor/range_image_message.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

namespace nextview {
namespace {

RangeImage make_image(int columns, int rows) {
  RangeImage image;
  image.pose = {Eigen::Vector3d(1.0, 2.0, 3.0), 0.3, -0.2};
  image.position_m = image.pose.position_m;
  image.world_from_sensor = world_from_sensor_rotation(0.3, -0.2);
  image.rays = make_ray_table(TiltedLineScan{columns, rows, 1.0, 0.7});
  image.limits = {0.05, 30.0};
  for (std::size_t i = 0; i < image.rays.pixels(); ++i) {
    image.range_m.push_back(quantise_range(0.1 + 1e-4 * static_cast<double>(i % 200000)));
  }
  image.range_m[1] = std::numeric_limits<float>::infinity();
  image.range_m[2] = std::numeric_limits<float>::quiet_NaN();
  return image;
}

bool same_bits(const std::vector<float>& a, const std::vector<float>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

TEST(RangeImageMessage, ComesOutAsItWentInWhateverTheOrderOfItsParts) {
  struct Size {
    int columns, rows;
    std::size_t parts;
  };
  for (const Size size :
       {Size{2, 2, 1}, Size{64, 30, 1}, Size{512, 256, 11}, Size{2, 1918, 1}, Size{960, 960, 76}}) {
    const RangeImage image = make_image(size.columns, size.rows);
    auto messages = range_image_messages(image, 4, 2, 1000);
    EXPECT_EQ(messages.size(), size.parts);
    for (const auto& message : messages) {
      EXPECT_EQ(check(message), "");
      EXPECT_LE(static_cast<std::size_t>(message.getEncodedSize()), kMaxMessageBytes);
    }
    std::ranges::shuffle(messages, std::mt19937(1));
    RangeImageAssembler assembler;
    for (std::size_t i = 0; i + 1 < messages.size(); ++i) {
      EXPECT_FALSE(assembler.add(messages[i]));
      EXPECT_FALSE(assembler.add(messages[i]));  // twice is once
    }
    const auto received = assembler.add(messages.back());
    ASSERT_TRUE(received);
    EXPECT_EQ(received->view, 4);
    EXPECT_EQ(received->attempt, 2);
    EXPECT_EQ(received->utime, 1000);
    EXPECT_EQ(received->image.world_from_sensor, image.world_from_sensor);
    EXPECT_EQ(received->image.position_m, image.position_m);
    EXPECT_EQ(received->image.pose.pan_rad, image.pose.pan_rad);
    EXPECT_EQ(received->image.rays.row_cos, image.rays.row_cos);
    EXPECT_EQ(received->image.limits.max_m, 30.0);
    EXPECT_TRUE(same_bits(received->image.range_m, image.range_m));
  }
}

// A quarter of a million points, of sensors whose lines stand upright.
TEST(RangeImageMessage, CarriesThePictureOfEverySensor) {
  const SensorGeometry sensors[] = {SphericalScanner{}, LineStriper{500, 500, 1.0, 0.8, 0.1}};
  for (const SensorGeometry& sensor : sensors) {
    RangeImage image = make_image(2, 2);
    image.rays = make_ray_table(sensor);
    const auto lines = static_cast<std::size_t>(image.rays.columns());
    image.range_m.clear();
    for (std::size_t i = 0; i < image.rays.pixels(); ++i) {
      image.range_m.push_back(quantise_range(0.1 + 1e-4 * static_cast<double>(i % 200000)));
    }
    const auto messages = range_image_messages(image, 1, 1, 0);
    EXPECT_EQ(messages.size(), 21u);
    RangeImageAssembler assembler;
    std::optional<ReceivedRangeImage> received;
    for (const range_image_t& message : messages) {
      EXPECT_EQ(check(message), "");
      EXPECT_EQ(message.geometry, static_cast<int>(kind_of(sensor)));
      EXPECT_EQ(message.columns, columns_of(sensor));
      EXPECT_EQ(message.rows, rows_of(sensor));
      received = assembler.add(message);
    }
    ASSERT_TRUE(received);
    EXPECT_EQ(received->image.rays.kind, kind_of(sensor));
    EXPECT_EQ(received->image.rays.column_sin, image.rays.column_sin);
    EXPECT_EQ(received->image.rays.row_cos, image.rays.row_cos);
    EXPECT_TRUE(same_bits(received->image.range_m, image.range_m));

    // The first pixels are the top row of the picture, and their rays what the type says.
    const range_image_t& first = messages[0];
    ASSERT_EQ(first.entries, first.columns + first.rows);
    const auto top = static_cast<std::size_t>(first.columns);
    for (std::size_t u = 0; u < 9; ++u) {
      EXPECT_EQ(first.range_m[u], image.range_m[u * lines]);
      const Eigen::Vector3d ray(-first.entry_sin[u] * first.entry_cos[top],
                                first.entry_cos[u] * first.entry_cos[top], first.entry_sin[top]);
      EXPECT_LT((ray - image.rays.ray(0, static_cast<int>(u))).norm(), 1e-15);
    }
  }
}

TEST(RangeImageMessage, KeepsImagesApart) {
  const RangeImage image = make_image(512, 256);
  const auto first = range_image_messages(image, 1, 1, 0);
  const auto second = range_image_messages(image, 2, 1, 0);
  RangeImageAssembler assembler;
  int whole = 0;
  for (std::size_t i = 0; i < first.size(); ++i) {
    whole += assembler.add(first[i]).has_value();
    whole += assembler.add(second[i]).has_value();
  }
  EXPECT_EQ(whole, 2);
}

TEST(RangeImageMessage, RejectsPartsThatContradictEachOther) {
  const auto parts = range_image_messages(make_image(512, 256), 1, 1, 0);
  RangeImageAssembler assembler;
  assembler.add(parts[0]);
  range_image_t elsewhere = parts[1];
  elsewhere.position_m[0] += 0.001;
  EXPECT_THROW(assembler.add(elsewhere), RejectedMessage);
  range_image_t overlapping = parts[1];
  overlapping.first_pixel -= 1;
  EXPECT_THROW(assembler.add(overlapping), RejectedMessage);
  std::optional<ReceivedRangeImage> received;
  for (std::size_t i = 1; i < parts.size(); ++i) received = assembler.add(parts[i]);
  EXPECT_TRUE(received);
}

TEST(RangeImageMessage, TravelsInPartsAsSmallAsWanted) {
  const RangeImage image = make_image(20, 10);
  for (const std::size_t part_bytes : {16U, 17U, 33U, 100U, 479U, 480U, 481U, 1200U, 49152U}) {
    auto messages = range_image_messages(image, 1, 1, 0, part_bytes);
    std::size_t entries = 0;
    for (const range_image_t& message : messages) {
      EXPECT_EQ(check(message), "") << part_bytes;
      EXPECT_LE(message.entry_sin.size() * 16 + message.range_m.size() * 4, part_bytes);
      entries += message.entry_sin.size();
    }
    EXPECT_EQ(entries, 30U) << "the ray table travels once";
    std::ranges::shuffle(messages, std::mt19937(2));
    RangeImageAssembler assembler;
    std::optional<ReceivedRangeImage> received;
    for (const range_image_t& message : messages) received = assembler.add(message);
    ASSERT_TRUE(received) << part_bytes;
    EXPECT_EQ(received->image.rays.column_sin, image.rays.column_sin);
    EXPECT_EQ(received->image.rays.row_cos, image.rays.row_cos);
    EXPECT_TRUE(same_bits(received->image.range_m, image.range_m));
    EXPECT_EQ(received->part_hashes.size(), messages.size());
  }
  EXPECT_THROW(range_image_messages(image, 1, 1, 0, 15), std::invalid_argument);
  EXPECT_THROW(range_image_messages(image, 1, 1, 0, kPartBytes + 1), std::invalid_argument);
}

ReceivedRangeImage received_of(const std::vector<range_image_t>& parts) {
  RangeImageAssembler assembler;
  for (const range_image_t& part : parts) {
    if (auto received = assembler.add(part)) return *received;
  }
  throw std::logic_error("not whole");
}

TEST(HistoryDigest, IsOfAllImagesSoFarWhateverTheRunOrTheOrderOfParts) {
  auto first = range_image_messages(make_image(20, 10), 1, 1, 0, 200);
  const auto second = range_image_messages(make_image(20, 10), 2, 1, 0, 200);
  const std::string one = history_digest("", received_of(first));
  EXPECT_EQ(one.size(), 32U);
  const std::string two = history_digest(one, received_of(second));
  EXPECT_NE(two, history_digest("", received_of(second)));
  std::ranges::reverse(first);
  for (range_image_t& part : first) part.run = 99;
  EXPECT_EQ(history_digest("", received_of(first)), one);
  first[0].range_m[0] = 29.0F;
  EXPECT_NE(history_digest("", received_of(first)), one);
}

}  // namespace
}  // namespace nextview

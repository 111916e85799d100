#include "sensor/range_image_message.h"

#include <algorithm>
#include <string>

namespace nextview {
namespace {

/// 48 KB of ranges; fewer where a large ray table needs the room.
constexpr std::size_t kPixelsPerPart = 12 * 1024;

range_image_t describe(const RangeImage& image, int view, int attempt, std::int64_t utime,
                       double scan_wall_s) {
  range_image_t message{};
  message.utime = utime;
  message.columns = image.rays.columns();
  message.rows = image.rays.rows();
  message.view = view;
  message.attempt = attempt;
  message.geometry = 0;
  message.column_sin = image.rays.column_sin;
  message.column_cos = image.rays.column_cos;
  message.row_sin = image.rays.row_sin;
  message.row_cos = image.rays.row_cos;
  message.range_min_m = image.limits.min_m;
  message.range_max_m = image.limits.max_m;
  message.pan_rad = image.pose.pan_rad;
  message.tilt_rad = image.pose.tilt_rad;
  for (int row = 0; row < 3; ++row) {
    message.position_m[row] = image.position_m[row];
    for (int column = 0; column < 3; ++column) {
      message.world_from_sensor[row][column] = image.world_from_sensor(row, column);
    }
  }
  message.scan_wall_s = scan_wall_s;
  return message;
}

/// Whether two parts are of the same image: everything but the pixels is the same.
bool same_image(const range_image_t& a, const range_image_t& b) {
  return a.utime == b.utime && a.columns == b.columns && a.rows == b.rows && a.parts == b.parts &&
         a.geometry == b.geometry && a.column_sin == b.column_sin && a.column_cos == b.column_cos &&
         a.row_sin == b.row_sin && a.row_cos == b.row_cos && a.range_min_m == b.range_min_m &&
         a.range_max_m == b.range_max_m && std::ranges::equal(a.position_m, b.position_m) &&
         a.pan_rad == b.pan_rad && a.tilt_rad == b.tilt_rad &&
         std::ranges::equal(a.world_from_sensor, b.world_from_sensor,
                            [](const auto& p, const auto& q) { return std::ranges::equal(p, q); });
}

ReceivedRangeImage received_image(const range_image_t& message, std::vector<float> range_m) {
  ReceivedRangeImage received;
  received.view = message.view;
  received.attempt = message.attempt;
  received.utime = message.utime;
  RangeImage& image = received.image;
  for (int row = 0; row < 3; ++row) {
    image.position_m[row] = message.position_m[row];
    for (int column = 0; column < 3; ++column) {
      image.world_from_sensor(row, column) = message.world_from_sensor[row][column];
    }
  }
  image.pose = {image.position_m, message.pan_rad, message.tilt_rad};
  image.rays = {message.column_sin, message.column_cos, message.row_sin, message.row_cos};
  image.limits = {message.range_min_m, message.range_max_m};
  image.range_m = std::move(range_m);
  return received;
}

}  // namespace

std::vector<range_image_t> range_image_messages(const RangeImage& image, int view, int attempt,
                                                std::int64_t utime, double scan_wall_s) {
  const range_image_t description = describe(image, view, attempt, utime, scan_wall_s);
  const auto described = static_cast<std::size_t>(description.getEncodedSize());
  const std::size_t per_part =
      std::clamp((kMaxMessageBytes - std::min(described, kMaxMessageBytes)) / sizeof(float),
                 std::size_t{1}, kPixelsPerPart);
  const std::size_t all = image.range_m.size();
  const std::size_t parts = (all + per_part - 1) / per_part;

  std::vector<range_image_t> messages(parts, description);
  for (std::size_t part = 0; part < parts; ++part) {
    const std::size_t first = part * per_part;
    const auto ranges = std::span(image.range_m).subspan(first, std::min(per_part, all - first));
    range_image_t& message = messages[part];
    message.part = static_cast<std::int32_t>(part);
    message.parts = static_cast<std::int32_t>(parts);
    message.first_pixel = static_cast<std::int32_t>(first);
    message.pixels = static_cast<std::int32_t>(ranges.size());
    message.range_m.assign(ranges.begin(), ranges.end());
  }
  return messages;
}

std::optional<ReceivedRangeImage> RangeImageAssembler::add(const range_image_t& part) {
  const MessageKey key{part.view, part.attempt, 0};
  const auto [entry, is_new] = assemblies_.try_emplace(key);
  Assembly& assembly = entry->second;
  if (is_new) {
    const auto pixels =
        static_cast<std::size_t>(part.columns) * static_cast<std::size_t>(part.rows);
    assembly.description = part;
    assembly.description.range_m.clear();
    assembly.range_m.resize(pixels);
    assembly.filled.resize(pixels);
    assembly.missing_pixels = static_cast<std::int64_t>(pixels);
  }
  if (!same_image(part, assembly.description)) {
    throw RejectedMessage("a part that is not of the same image as the parts before it");
  }
  if (assembly.parts.contains(part.part)) return std::nullopt;
  const auto first = assembly.filled.begin() + part.first_pixel;
  if (std::find(first, first + part.pixels, true) != first + part.pixels) {
    throw RejectedMessage("a part whose pixels another part has");
  }

  assembly.parts.insert(part.part);
  std::fill_n(first, part.pixels, true);
  std::ranges::copy(part.range_m, assembly.range_m.begin() + part.first_pixel);
  assembly.missing_pixels -= part.pixels;
  if (assembly.missing_pixels > 0) return std::nullopt;

  ReceivedRangeImage received = received_image(assembly.description, std::move(assembly.range_m));
  assemblies_.erase(entry);
  return received;
}

}  // namespace nextview

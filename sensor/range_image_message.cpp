#include "sensor/range_image_message.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "lcmtypes/decode.h"
#include "sensor/range_picture.h"

namespace nextview {
namespace {

constexpr std::size_t kEntryBytes = 2 * sizeof(double);

range_image_t describe(const RangeImage& image, const PictureRays& picture, int view, int attempt,
                       std::int64_t utime) {
  range_image_t message{};
  message.utime = utime;
  message.view = view;
  message.attempt = attempt;
  message.geometry = static_cast<std::int8_t>(picture.kind);
  message.columns = static_cast<std::int32_t>(picture.column_sin.size());
  message.rows = static_cast<std::int32_t>(picture.row_sin.size());
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
  return message;
}

/// Whether two parts are of the same image: all that is said of the whole is the same.
bool same_image(const range_image_t& a, const range_image_t& b) {
  return a.utime == b.utime && a.columns == b.columns && a.rows == b.rows && a.parts == b.parts &&
         a.geometry == b.geometry && a.range_min_m == b.range_min_m &&
         a.range_max_m == b.range_max_m && std::ranges::equal(a.position_m, b.position_m) &&
         a.pan_rad == b.pan_rad && a.tilt_rad == b.tilt_rad &&
         std::ranges::equal(a.world_from_sensor, b.world_from_sensor,
                            [](const auto& p, const auto& q) { return std::ranges::equal(p, q); });
}

/// Where a part's slice begins and ends in the sequence of entries and pixels.
std::int64_t begin_of(const range_image_t& part) {
  if (part.entries > 0) return part.first_entry;
  return std::int64_t{part.columns} + part.rows + part.first_pixel;
}
std::int64_t end_of(const range_image_t& part) {
  return begin_of(part) + part.entries + part.pixels;
}

/// Whether two parts can be of one sequence, the first one before the second.
bool in_order(const range_image_t& before, const range_image_t& after) {
  const bool neighbours = before.part + 1 == after.part;
  return neighbours ? end_of(before) == begin_of(after) : end_of(before) < begin_of(after);
}

template <class T>
void append(std::vector<T>& to, const std::vector<T>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

/// The rays of a table's entries: those of the columns, then those of the rows.
PictureRays rays_of(SensorKind kind, const std::vector<double>& sines,
                    const std::vector<double>& cosines, int columns) {
  return {kind,
          {sines.begin(), sines.begin() + columns},
          {cosines.begin(), cosines.begin() + columns},
          {sines.begin() + columns, sines.end()},
          {cosines.begin() + columns, cosines.end()}};
}

ReceivedRangeImage join(const std::map<int, range_image_t>& parts) {
  const range_image_t& first = parts.begin()->second;
  ReceivedRangeImage received;
  received.view = first.view;
  received.attempt = first.attempt;
  received.utime = first.utime;
  RangeImage& image = received.image;
  for (int row = 0; row < 3; ++row) {
    image.position_m[row] = first.position_m[row];
    for (int column = 0; column < 3; ++column) {
      image.world_from_sensor(row, column) = first.world_from_sensor[row][column];
    }
  }
  image.pose = {image.position_m, first.pan_rad, first.tilt_rad};
  image.limits = {first.range_min_m, first.range_max_m};
  const auto columns = static_cast<std::size_t>(first.columns);
  image.range_m.reserve(columns * static_cast<std::size_t>(first.rows));
  std::vector<double> sines;
  std::vector<double> cosines;
  for (const auto& [number, part] : parts) {
    append(sines, part.entry_sin);
    append(cosines, part.entry_cos);
    append(image.range_m, part.range_m);
  }
  const auto kind = static_cast<SensorKind>(first.geometry);
  image.rays = table_of_picture(rays_of(kind, sines, cosines, first.columns));
  if (has_upright_lines(kind)) image.range_m = transposed(image.range_m, columns);
  return received;
}

Hash128 hash_of(range_image_t part) {
  part.run = 0;
  const std::vector<std::uint8_t> bytes = encode(part);
  const XXH128_hash_t hash = XXH3_128bits(bytes.data(), bytes.size());
  return {hash.high64, hash.low64};
}

std::string hexadecimal(const XXH128_hash_t& hash) {
  return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

}  // namespace

std::vector<range_image_t> range_image_messages(const RangeImage& image, int view, int attempt,
                                                std::int64_t utime, std::size_t part_bytes) {
  if (part_bytes < kEntryBytes || part_bytes > kPartBytes) {
    throw std::invalid_argument("a part of a range image carries " + std::to_string(kEntryBytes) +
                                " to " + std::to_string(kPartBytes) + " bytes, not " +
                                std::to_string(part_bytes));
  }
  const PictureRays picture = picture_rays(image.rays);
  std::vector<double> sines = picture.column_sin;
  append(sines, picture.row_sin);
  std::vector<double> cosines = picture.column_cos;
  append(cosines, picture.row_cos);

  std::vector<float> turned;
  if (has_upright_lines(picture.kind)) {
    turned = transposed(image.range_m, image.rays.column_sin.size());
  }
  const std::vector<float>& range_m = turned.empty() ? image.range_m : turned;

  const range_image_t description = describe(image, picture, view, attempt, utime);
  std::vector<range_image_t> messages;
  std::size_t entry = 0;
  std::size_t pixel = 0;
  while (pixel < range_m.size()) {
    const std::size_t entries = std::min(part_bytes / kEntryBytes, sines.size() - entry);
    const std::size_t room =
        entry + entries < sines.size() ? 0 : part_bytes - entries * kEntryBytes;
    const std::size_t pixels = std::min(room / sizeof(float), range_m.size() - pixel);
    range_image_t& message = messages.emplace_back(description);
    message.part = static_cast<std::int32_t>(messages.size()) - 1;
    message.first_entry = static_cast<std::int32_t>(entry);
    message.entries = static_cast<std::int32_t>(entries);
    const auto entry_end = static_cast<std::ptrdiff_t>(entry + entries);
    message.entry_sin.assign(sines.begin() + static_cast<std::ptrdiff_t>(entry),
                             sines.begin() + entry_end);
    message.entry_cos.assign(cosines.begin() + static_cast<std::ptrdiff_t>(entry),
                             cosines.begin() + entry_end);
    message.first_pixel = static_cast<std::int32_t>(pixel);
    message.pixels = static_cast<std::int32_t>(pixels);
    const auto first = range_m.begin() + static_cast<std::ptrdiff_t>(pixel);
    message.range_m.assign(first, first + static_cast<std::ptrdiff_t>(pixels));
    entry += entries;
    pixel += pixels;
  }
  for (range_image_t& message : messages) {
    message.parts = static_cast<std::int32_t>(messages.size());
  }
  return messages;
}

std::string history_digest(const std::string& previous, const ReceivedRangeImage& received) {
  std::string bytes = previous;
  const auto put = [&bytes](std::uint64_t value) {  // big-endian, as XXH128_canonical_t
    for (int shift = 56; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift & 0xffU);
  };
  for (const auto& [high, low] : received.part_hashes) {
    put(high);
    put(low);
  }
  return hexadecimal(XXH3_128bits(bytes.data(), bytes.size()));
}

std::optional<ReceivedRangeImage> RangeImageAssembler::add(const range_image_t& part) {
  const MessageKey key{part.view, part.attempt, 0};
  Assembly& assembly = assemblies_[key];
  std::map<int, range_image_t>& parts = assembly.parts;
  if (!parts.empty() && !same_image(part, parts.begin()->second)) {
    throw RejectedMessage("a part that is not of the same image as the parts before it");
  }
  if (parts.contains(part.part)) return std::nullopt;
  const auto after = parts.upper_bound(part.part);
  if ((after != parts.end() && !in_order(part, after->second)) ||
      (after != parts.begin() && !in_order(std::prev(after)->second, part))) {
    throw RejectedMessage("a part that overlaps another part or leaves a gap to it");
  }

  parts.emplace_hint(after, part.part, part);
  assembly.hashes.emplace(part.part, hash_of(part));
  if (std::ssize(parts) < part.parts) return std::nullopt;

  // Neighbours meet, and check() has seen that the ends are at the ends.
  ReceivedRangeImage received = join(parts);
  for (const auto& [number, hash] : assembly.hashes) received.part_hashes.push_back(hash);
  assemblies_.erase(key);
  return received;
}

std::vector<MessageKey> RangeImageAssembler::incomplete() const {
  std::vector<MessageKey> keys;
  keys.reserve(assemblies_.size());
  for (const auto& [key, assembly] : assemblies_) keys.push_back(key);
  return keys;
}

bool RangeImageAssembler::has_part_of(int view) const {
  const auto first = assemblies_.lower_bound({view, 0, 0});
  return first != assemblies_.end() && first->first.view == view;
}

std::vector<PartRange> RangeImageAssembler::lacking(int view, int attempt) const {
  const auto found = assemblies_.find({view, attempt, 0});
  if (found == assemblies_.end() || found->second.parts.empty()) return {};
  const std::map<int, range_image_t>& parts = found->second.parts;
  std::vector<PartRange> ranges;
  int next = 0;
  for (const auto& [number, part] : parts) {
    if (number > next) ranges.push_back({next, number - 1});
    next = number + 1;
  }
  const int all = parts.begin()->second.parts;
  if (next < all) ranges.push_back({next, all - 1});
  return ranges;
}

void RangeImageAssembler::forget_until(int view) {
  assemblies_.erase(assemblies_.begin(), assemblies_.lower_bound({view + 1, 0, 0}));
}

void request_range_image(Bus& bus, const RangeImageAssembler& assembler, int view, int attempt) {
  bool in_parts = false;
  for (const MessageKey& key : assembler.incomplete()) {
    if (key.view != view || (attempt != 0 && key.attempt != attempt)) continue;
    const std::vector<PartRange> parts = assembler.lacking(key.view, key.attempt);
    if (parts.empty()) continue;
    bus.request_parts<range_image_t>(key.view, key.attempt, parts);
    in_parts = true;
  }
  if (!in_parts) bus.request<range_image_t>(view, attempt);
}

}  // namespace nextview

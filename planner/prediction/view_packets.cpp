#include "planner/prediction/view_packets.h"

#include <algorithm>

#include "sensor/sensor_pose.h"

namespace nextview {

namespace {

constexpr std::size_t kPacketRays = RayBundle::kPacketRays;

// The place of a direction along Morton's curve: those that are near each other on it are near each
// other in direction.
std::uint32_t place_of(const IntegerLine& line) {
  constexpr int kBits = 11;
  constexpr int kDropped = IntegerLine::kFractionBits + 1 - kBits;
  std::uint32_t place = 0;
  for (int across = 1; across <= 2; ++across) {
    const std::int32_t slope = line.slope[(line.driving_axis + across) % 3];
    const auto cell =
        static_cast<std::uint32_t>(slope + (1 << IntegerLine::kFractionBits)) >> kDropped;
    for (int bit = 0; bit <= kBits; ++bit) place |= (cell >> bit & 1) << (2 * bit + across - 1);
  }
  return place;
}

}  // namespace

std::array<std::vector<RayPacket>, 6> packets_of(const RayTable& rays,
                                                 const Orientation& orientation,
                                                 std::int32_t number, double reach) {
  const Eigen::Matrix3d rotation =
      world_from_sensor_rotation(orientation.pan_rad, orientation.tilt_rad);
  std::array<std::vector<TabulatedRay>, 6> tabulated;
  for (int v = 0; v < rays.rows(); ++v) {
    for (int u = 0; u < rays.columns(); ++u) {
      const Eigen::Vector3d direction = rotation * rays.ray(u, v);
      const IntegerLine line = line_along(VoxelIndex::Zero(), direction, reach);
      tabulated[static_cast<std::size_t>(2 * line.driving_axis + (line.direction < 0))].push_back(
          {line, quantise_direction(direction), place_of(line)});
    }
  }
  std::array<std::vector<RayPacket>, 6> packets;
  for (std::size_t table = 0; table < tabulated.size(); ++table) {
    auto& sorted = tabulated[table];
    std::stable_sort(
        sorted.begin(), sorted.end(),
        [](const TabulatedRay& a, const TabulatedRay& b) { return a.place < b.place; });
    for (std::size_t begin = 0; begin < sorted.size(); begin += kPacketRays) {
      RayPacket packet{number, {}, std::min(kPacketRays, sorted.size() - begin)};
      for (std::size_t i = 0; i < kPacketRays; ++i) {
        packet.rays[i] = sorted[begin + std::min(i, packet.count - 1)];
      }
      packets[table].push_back(packet);
    }
  }
  return packets;
}

void append(const RayPacket& packet, RayBundle& bundle) {
  bundle.group.push_back(packet.orientation);
  RayBundle::Packet& columns = bundle.packets.emplace_back();
  for (std::size_t i = 0; i < kPacketRays; ++i) {
    const IntegerLine& line = packet.rays[i].line;
    columns.slope1[i] = line.slope[(line.driving_axis + 1) % 3];
    columns.slope2[i] = line.slope[(line.driving_axis + 2) % 3];
    columns.reach[i] = i < packet.count ? line.steps : -1;
  }
}

}  // namespace nextview

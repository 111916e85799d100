#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "mapper/integer_line.h"
#include "planner/prediction/orientations.h"
#include "planner/prediction/predicted_quality.h"
#include "planner/prediction/ray_kernel.h"
#include "sensor/sensor_geometry.h"

namespace nextview {

/// A ray of a view, whatever the sensor's voxel.
struct TabulatedRay {
  IntegerLine line;              ///< from voxel (0, 0, 0)
  QuantisedDirection direction;  ///< world frame
  std::uint32_t place;           ///< along a curve through all directions with its driving axis
};

/// As many rays of one view as a RayBundle::Packet holds, neighbours of each other.
struct RayPacket {
  std::int32_t orientation;
  std::array<TabulatedRay, RayBundle::kPacketRays> rays;
  std::size_t count;  ///< of rays; the others are copies of the last

  std::uint32_t place() const { return rays[count / 2].place; }
};

/// The rays of an orientation in packets, by driving axis and sign: 2 axis + (sign < 0).
/// @param number the orientation's, for RayPacket::orientation
/// @param reach of the rays, in voxels
std::array<std::vector<RayPacket>, 6> packets_of(const RayTable& rays,
                                                 const Orientation& orientation,
                                                 std::int32_t number, double reach);

/// Adds a packet to a bundle, in the group of its orientation.
void append(const RayPacket& packet, RayBundle& bundle);

}  // namespace nextview

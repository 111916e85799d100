#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mapper/voxel_map.h"
#include "planner/unseen_boundary.h"
#include "sensor/sensor_pose.h"

namespace nextview {

/// From where a picture is taken and how large it is.
struct PictureView {
  int width = 1600;            ///< pixels
  int height = 1000;           ///< pixels, the legend aside
  double azimuth_deg = 245.0;  ///< from where the map's middle is looked at, 0 = from +x, 90 = +y
  double elevation_deg = 48.0;
};

/// An image of 8-bit red, green and blue, row by row from the top.
struct Picture {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;
};

/// What of the CAD model's surface has not been recovered, by the voxels it lies in.
struct MissedSurface {
  std::vector<VoxelIndex> can_be_seen;    ///< not Occupied, with surface that can be seen
  std::vector<VoxelIndex> never_visible;  ///< unknown, with surface, none of which can be seen
};

/// Sorts the samples of a scene's surface into voxels.
/// @param visible those of them that can be seen from somewhere reachable
MissedSurface missed_surface(const VoxelMap& map, std::span<const Eigen::Vector3f> samples_m,
                             std::span<const Eigen::Vector3f> visible_m);

/// What is drawn besides the Occupied voxels.
struct DrawnRun {
  std::span<const SensorPose> poses;
  std::span<const UnseenVoxel> unseen;  ///< when the run ended
  std::optional<MissedSurface> missed;  ///< where it is known what can be seen
};

/// The recovered scene as in figure 9 of the paper: the Occupied voxels' faces that touch Empty
/// space, coloured by height, with the sensor's path dashed and its poses and directions drawn.
/// Faces are seen from their Empty side only, so one looks through ceiling and walls into the room.
///
/// Faces of unknown voxels that touch Empty space, which is what remains unseen, have a colour for
/// the best place it could be looked at from; where only surface that is never visible lies in
/// them, one of their own. Voxels with surface that can be seen and is not recovered are red cubes.
/// @throws std::invalid_argument when no voxel is Occupied
Picture recovered_picture(const VoxelMap& map, const DrawnRun& run, const PictureView& view);

/// What a line of the legend says of a colour.
struct LegendLine {
  std::array<float, 3> from;  ///< red, green and blue from 0 to 1,
  std::array<float, 3> to;    ///< and what they go over into
  std::string text;
};

/// What the picture of a run holds: its colours, arrows and white gaps. Of the colours of what
/// remains unseen, those that are in it, with their areas.
std::vector<LegendLine> legend_of(const VoxelMap& map, const DrawnRun& run);

}  // namespace nextview

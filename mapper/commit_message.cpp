#include "mapper/commit_message.h"

namespace nextview {
namespace {

std::int64_t count(const MapStatistics& statistics, Label label) {
  return statistics.voxels[static_cast<std::size_t>(label)];
}

}  // namespace

commit_t commit_message(const ReceivedRangeImage& received, const FoldCounts& folded,
                        const MapStatistics& statistics) {
  commit_t commit{};
  commit.utime = received.utime;
  commit.view = received.view;
  commit.attempt = received.attempt;
  for (int axis = 0; axis < 3; ++axis) {
    commit.used_position_m[axis] = received.image.position_m[axis];
  }
  commit.pan_rad = received.image.pose.pan_rad;
  commit.tilt_rad = received.image.pose.tilt_rad;
  commit.unmarked_voxels = count(statistics, Label::Unmarked);
  commit.occluded_voxels = count(statistics, Label::Occluded);
  commit.occlusion_plane_voxels = count(statistics, Label::OcclusionPlane);
  commit.empty_voxels = count(statistics, Label::Empty);
  commit.occupied_voxels = count(statistics, Label::Occupied);
  commit.newly_occupied_voxels = folded.newly_occupied;
  commit.occupied_area_m2 = statistics.occupied_area_m2;
  commit.occlusion_plane_area_m2 = statistics.occlusion_plane_area_m2;
  commit.mean_quality = statistics.mean_quality;
  commit.min_quality = statistics.min_quality;
  commit.points = folded.points;
  commit.points_outside = folded.points_outside;
  commit.no_returns = folded.no_returns;
  commit.invalid = folded.invalid;
  return commit;
}

}  // namespace nextview

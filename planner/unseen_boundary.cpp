#include "planner/unseen_boundary.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

#include "mapper/integer_line.h"
#include "planner/prediction/orientations.h"

namespace nextview {

namespace {

using Place = UnseenFrom;

Place place_of(const ClearSpace& space, const ShortestPaths& paths, const VoxelIndex& voxel) {
  const ClearSpace::Cell cell = space.cell(voxel);
  if (paths.length_m(voxel) != ShortestPaths::kUnreachable) return Place::InView;
  if (space.is_blocked(cell)) return Place::Refused;
  if (space.is_clear_beyond_limits(cell)) return Place::BeyondLift;
  if (space.is_clear(cell)) return Place::NoPath;
  return Place::TooNear;
}

int empty_faces(const VoxelMap& map, const VoxelIndex& voxel) {
  int faces = 0;
  for (int axis = 0; axis < 3; ++axis) {
    for (const int sign : {-1, 1}) {
      VoxelIndex neighbour = voxel;
      neighbour[axis] += sign;
      faces += map.label(neighbour) == Label::Empty ? 1 : 0;
    }
  }
  return faces;
}

Place best_place(const VoxelMap& map, const ClearSpace& space, const ShortestPaths& paths,
                 const VoxelIndex& voxel, const std::vector<IntegerLine>& lines) {
  Place best = Place::Nowhere;
  for (IntegerLine line : lines) {
    line.start = voxel;
    for (int k = 1; k <= line.steps; ++k) {
      const VoxelIndex at = line.at(k);
      if (map.label(at) != Label::Empty) break;
      best = std::max(best, place_of(space, paths, at));
      if (best == Place::InView) return best;
    }
  }
  return best;
}

}  // namespace

std::vector<UnseenVoxel> unseen_voxels(const VoxelMap& map, const ClearSpace& space,
                                       const ShortestPaths& paths, double range_m) {
  const double voxel_m = map.grid().voxel_size_m;
  const double reach = std::clamp(range_m / voxel_m, 1.0, double{IntegerLine::kMaxSteps});
  std::vector<IntegerLine> lines;
  for (const Orientation& orientation : icosahedron_orientations(1)) {
    lines.push_back(line_along(VoxelIndex::Zero(), orientation.direction, reach));
  }
  std::vector<UnseenVoxel> unseen;
  const VoxelIndex end = map.window().min + map.window().size;
  for (int k = map.window().min[2]; k < end[2]; ++k) {
    for (int j = map.window().min[1]; j < end[1]; ++j) {
      for (int i = map.window().min[0]; i < end[0]; ++i) {
        const VoxelIndex voxel(i, j, k);
        const Label label = map.labels()[map.slot(voxel)];
        if (label == Label::Empty || label == Label::Occupied) continue;
        const int faces = empty_faces(map, voxel);
        if (faces == 0) continue;
        unseen.push_back({voxel, faces, best_place(map, space, paths, voxel, lines)});
      }
    }
  }
  return unseen;
}

UnseenBoundary unseen_boundary(const VoxelMap& map, const ClearSpace& space,
                               const ShortestPaths& paths, double range_m) {
  const double voxel_m = map.grid().voxel_size_m;
  std::array<double, kUnseenFromCount> area_m2 = {};
  for (const UnseenVoxel& unseen : unseen_voxels(map, space, paths, range_m)) {
    area_m2[static_cast<std::size_t>(unseen.from)] += unseen.empty_faces * voxel_m * voxel_m;
  }
  const auto of = [&](Place place) { return area_m2[static_cast<std::size_t>(place)]; };
  return {.in_view_m2 = of(Place::InView),
          .refused_m2 = of(Place::Refused),
          .beyond_lift_m2 = of(Place::BeyondLift),
          .no_path_m2 = of(Place::NoPath),
          .too_near_m2 = of(Place::TooNear),
          .from_nowhere_m2 = of(Place::Nowhere)};
}

std::string describe(const UnseenBoundary& boundary) {
  std::string text = fmt::format("{:.2f} m2 of boundary left unseen", boundary.total_m2());
  const char* separator = ": ";
  const auto add = [&](double area_m2, const char* why) {
    if (area_m2 <= 0.0) return;
    text += fmt::format("{}{:.2f} m2 {}", separator, area_m2, why);
    separator = ", ";
  };
  add(boundary.in_view_m2, "in view, where views show too little");
  add(boundary.refused_m2, "seen only from where the base refused to go");
  add(boundary.beyond_lift_m2, "seen only from beyond the lift or workspace");
  add(boundary.no_path_m2, "seen only from where no path leads");
  add(boundary.too_near_m2, "seen only from too near to obstacles");
  add(boundary.from_nowhere_m2, "seen from nowhere known");
  return text;
}

}  // namespace nextview

// A planner of one's own in the place of nextview's: ./run --planner PATH/frontier_planner
//
// It goes where the field has gone since B. Yamauchi, "A frontier-based approach for autonomous
// exploration" (1997): to the nearest place from which a frontier, where known free space meets the
// unknown, can be seen. Only the choice is ours here; map, paths and everything said on the bus are
// nextview's.
#include <set>
#include <tuple>

#include "lcmtypes/bus_process.h"
#include "mapper/mapper_config.h"
#include "planner/clear_space.h"
#include "planner/planner_config.h"
#include "planner/planner_process.h"
#include "planner/prediction/orientations.h"
#include "planner/refused_places.h"
#include "planner/segment_walk.h"
#include "planner/shortest_paths.h"

namespace {

using namespace nextview;

class FrontierStrategy : public Strategy {
 public:
  explicit FrontierStrategy(const run_config_t& config) : config_(config) {}

  KnownSpace::Surfaces surfaces() const override { return KnownSpace::Surfaces::Leave; }
  std::optional<Ending> ending() const override { return std::nullopt; }
  void view_folded(const FoldedView& folded) override {
    const auto& changed = folded.report.changed_slots;
    changed_.insert(changed_.end(), changed.begin(), changed.end());
  }

  NextView next_view(const Situation& now) override {
    const VoxelMap& map = now.space.map();
    follow(map);
    if (!now.refused.empty()) refused_.add(*clear_, way_m_, now.refused.size());
    paths_.find(*clear_, map, now.present.position_m,
                now.view == 2 ? config_.planner.departure_m : config_.planner.later_departure_m);
    int positions = 0;
    std::vector<TriedPosition> tried;
    for (const VoxelIndex& voxel : paths_.reached()) {  // nearest first
      if (!on_lattice(voxel, now.seed)) continue;
      ++positions;
      const View view = best_view(map, voxel);
      const Orientation& look = orientations_[view.orientation];
      const SensorPose pose{map.grid().center_m(voxel), look.pan_rad, look.tilt_rad};
      if (tried.size() < kMostTried) {
        tried.push_back({pose.position_m, pose.pan_rad, pose.tilt_rad, view.frontiers / 100.0});
      }
      if (view.frontiers < kLeastFrontiers) continue;
      looked_.insert({voxel.x(), voxel.y(), voxel.z(), view.orientation});
      way_m_ = paths_.waypoints_m(voxel);
      Decision decision;
      decision.pose = pose;
      decision.waypoints_m = way_m_;
      decision.strategy = config_.strategy;  // what the run calls whatever planner it has
      decision.reason = "the nearest with frontiers, along " + std::to_string(view.frontiers) +
                        " of " + std::to_string(directions_.size()) + " directions";
      decision.evaluations = positions;
      decision.tried = std::move(tried);
      return decision;
    }
    return Ending{StopReason::NothingLeft,
                  "No frontier from " + std::to_string(positions) + " positions."};
  }

 private:
  static constexpr int kSpacing = 3;         // voxels between positions
  static constexpr int kLeastFrontiers = 3;  // directions that must end at one
  static constexpr double kRange_m = 5.0;    // in which frontiers count
  static constexpr std::size_t kMostTried = 1000;
  struct View {
    std::size_t orientation = 0;
    int frontiers = 0;
  };
  using Key = std::tuple<int, int, int, std::size_t>;  // voxel and orientation

  void follow(const VoxelMap& map) {
    if (!clear_) clear_.emplace(map, feasibility_of(config_));
    refused_.forget_near(*clear_, map, clear_->update(map, std::exchange(changed_, {})));
  }

  // The seed moves the lattice, so that runs differ.
  static bool on_lattice(const VoxelIndex& voxel, std::int64_t seed) {
    for (int axis = 0; axis < 3; ++axis) {
      const int phase = static_cast<int>(seed >> (2 * axis) & 3);
      if ((voxel[axis] + 4096 * kSpacing + phase) % kSpacing != 0) return false;
    }
    return true;
  }

  bool is_frontier(const VoxelMap& map, const Eigen::Vector3d& from_m,
                   const Eigen::Vector3d& direction) const {
    const double range_m = std::min(kRange_m, config_.sensor.range_max_m);
    for (SegmentWalk walk(map.grid(), from_m, from_m + range_m * direction);; walk.step()) {
      const Label label = map.label(walk.voxel());
      if (!map.contains(walk.voxel()) || label == Label::Occupied) return false;
      if (label != Label::Empty) return true;
      if (walk.at_end()) return false;
    }
  }

  // Of those not looked at before, the one with most frontiers around its axis.
  View best_view(const VoxelMap& map, const VoxelIndex& voxel) const {
    constexpr double kCosOfHalfAperture = 0.93;
    std::vector<Eigen::Vector3d> frontiers;
    for (const Orientation& each : directions_) {
      if (is_frontier(map, map.grid().center_m(voxel), each.direction)) {
        frontiers.push_back(each.direction);
      }
    }
    View best;
    for (std::size_t i = 0; i < orientations_.size(); ++i) {
      View view{i, 0};
      for (const Eigen::Vector3d& frontier : frontiers) {
        view.frontiers += frontier.dot(orientations_[i].direction) > kCosOfHalfAperture;
      }
      const Key key{voxel.x(), voxel.y(), voxel.z(), i};
      if (view.frontiers > best.frontiers && !looked_.contains(key)) best = view;
    }
    return best;
  }

  run_config_t config_;
  std::vector<Orientation> orientations_ = icosahedron_orientations(1);  // 80 to choose from
  std::vector<Orientation> directions_ = icosahedron_orientations(2);    // 320 to look along
  std::optional<ClearSpace> clear_;
  ShortestPaths paths_;
  RefusedPlaces refused_;
  std::vector<std::uint32_t> changed_;  // slots, folded and not yet followed
  std::vector<Eigen::Vector3d> way_m_;  // of the last decision
  std::set<Key> looked_;
};

std::unique_ptr<BusProcess> make_planner(Bus& bus, const run_config_t& config) {
  return std::make_unique<PlannerProcess>(
      bus, config,
      std::make_unique<ViewPlanner>(
          grid_of(config), window_of(config), std::make_unique<FrontierStrategy>(config),
          ViewPlanner::Parameters{config.seed, config.planner.max_views, config.planner.threads}));
}

}  // namespace

int main(int argc, char** argv) {
  return run_bus_process(argc, argv, "planner", "Goes to the nearest frontier.", make_planner);
}

#include "tests/system/explored_room.h"

#include <memory>
#include <optional>
#include <variant>

#include "base_sim/base_sim_process.h"
#include "planner/planner_config.h"
#include "sensor/sensor_config.h"
#include "sensor_sim/scan.h"

namespace nextview {
namespace {

/// Drives to the next view, or to that of a later attempt when the base refuses; nothing when the
/// planner ends the run.
std::optional<SensorPose> go_on(ViewPlanner& planner, Base& base) {
  while (const auto* decision = std::get_if<Decision>(&planner.next_view())) {
    const Motion motion = base.move(decision->waypoints_m, decision->pose);
    if (motion.arrived) return motion.pose;
    planner.refuse();
  }
  return std::nullopt;
}

}  // namespace

RunSetup room_setup(const std::string& room, const std::string& strategy, std::int64_t seed,
                    int views) {
  RunOptions options;
  options.scenes_folder = NEXTVIEW_SOURCE_DIR "/scenes";
  options.scene = room;
  options.strategy = strategy;
  options.seed = seed;
  options.views = views;
  return prepare_run(options);
}

void explore(const RunSetup& setup, const ViewTaken& view_taken) {
  const run_config_t& config = setup.config;
  const std::unique_ptr<ViewPlanner> planner = make_view_planner(config);
  Base base(base_limits_of(config), start_pose_of(config), *setup.scene);
  const RayTable rays = make_ray_table(sensor_of(config));
  RandomStream no_noise(config.seed, 0, 0, RandomPurpose::RangeNoise);
  for (std::optional<SensorPose> pose = start_pose_of(config); pose; pose = go_on(*planner, base)) {
    const RangeImage image =
        scan(*setup.scene, rays, range_limits_of(config), *pose, 0.0, no_noise);
    const FoldReport& fold = planner->fold(image);
    view_taken(*planner, fold, image);
  }
}

}  // namespace nextview

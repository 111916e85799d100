#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <optional>
#include <utility>
#include <vector>

#include "lcmtypes/nearest_option.h"
#include "lcmtypes/program_version.h"
#include "lcmtypes/standard_output.h"
#include "logger/recovered_run.h"
#include "planner/planner_config.h"
#include "reports/picture_file.h"
#include "reports/recovered_picture.h"
#include "scene/mesh_file.h"
#include "scene/scene_config.h"
#include "scoring/coverage_unknown.h"
#include "scoring/kept_file.h"
#include "scoring/surface_samples.h"
#include "scoring/visibility_config.h"

namespace {

using nextview::run_config_t;

/// What remains unseen after the last pose, by where it could be looked at from. Around goals that
/// the base refused there is no going.
std::vector<nextview::UnseenVoxel> unseen_at_end(const run_config_t& config,
                                                 const nextview::RunRecord& record,
                                                 const nextview::VoxelMap& map,
                                                 const std::vector<nextview::SensorPose>& poses) {
  nextview::ClearSpace space(map, nextview::feasibility_of(config));
  for (const auto& [key, arrival] : record.arrivals()) {
    const nextview::goal_t* goal = record.goal(key.view, key.attempt);
    if (arrival.arrived || goal == nullptr) continue;
    space.block(Eigen::Vector3d(goal->position_m), config.planner.clearance_m);
  }
  const bool has_moved = poses.size() > 1;
  nextview::ShortestPaths paths;
  paths.find(space, map, poses.back().position_m,
             has_moved ? config.planner.later_departure_m : config.planner.departure_m);
  return nextview::unseen_voxels(map, space, paths, config.sensor.range_max_m);
}

/// Nothing where the CAD model is gone or it is not kept what can be seen of it.
std::optional<nextview::MissedSurface> missed_at_end(const run_config_t& config,
                                                     const nextview::VoxelMap& map,
                                                     const Eigen::Vector3d& start_m,
                                                     const std::string& cache) {
  if (config.scene_file.empty()) return std::nullopt;
  try {
    const nextview::Scene scene = nextview::load_scene(config);
    const auto surface = nextview::visible_surface_if_kept(
        cache, scene, config.scene_digest, start_m, nextview::visibility_of(config));
    if (!surface) return std::nullopt;
    return nextview::missed_surface(
        map, nextview::sample_surface(scene.mesh(), surface->samples_per_m2), surface->points_m);
  } catch (const nextview::SceneError&) {
    return std::nullopt;
  } catch (const nextview::CoverageUnknown&) {
    return std::nullopt;
  }
}

void draw_run(const std::filesystem::path& folder, const std::filesystem::path& file, int views,
              bool occupied_only, const std::string& cache, const nextview::PictureView& view) {
  const nextview::RecoveredRun run = nextview::recover_run(folder, std::nullopt, views);
  std::vector<nextview::SensorPose> poses;
  for (const auto* received : run.images) poses.push_back(received->image.pose);
  const nextview::VoxelMap& map = run.builder.map();
  std::vector<nextview::UnseenVoxel> unseen;
  std::optional<nextview::MissedSurface> missed;
  if (!occupied_only) {
    unseen = unseen_at_end(run.config(), run.log.record(), map, poses);
    missed = missed_at_end(run.config(), map, poses.front().position_m, cache);
  }
  const nextview::DrawnRun drawn{poses, unseen, std::move(missed)};
  write_png(recovered_picture(map, drawn, view), nextview::legend_of(map, drawn), file);
  std::cout << file.string() << ": " << poses.size() << " views" << std::endl;
}

}  // namespace

int main(int argc, char** argv) {
  nextview::answer_for_standard_output();
  CLI::App app{
      "Draws what a run has recovered (paper figure 9): Occupied voxels coloured by height, the\n"
      "sensor's path dashed, its poses with their directions; and what remains unseen, coloured "
      "by\n"
      "where it could be looked at from. From the log alone. Where the CAD model is at hand and\n"
      "its surface coverage kept, tells what is unseen from what is never visible. A legend says\n"
      "what the colours are.\n"};
  std::string folder;
  std::string file;
  std::string cache;
  int views = std::numeric_limits<int>::max();
  bool occupied_only = false;
  nextview::PictureView view;
  app.add_option("DIR", folder, "Folder of a run")->required()->check(CLI::ExistingDirectory);
  app.add_option("FILE", file, "PNG file to write; default DIR/recovered.png");
  app.add_option("--views", views, "Draw the map after this many views; default all")
      ->check(CLI::PositiveNumber);
  app.add_flag("--occupied-only", occupied_only,
               "Leave out what remains unseen, as the paper does");
  app.add_option("--cache", cache, "Where surface coverage is kept; default as of ./run");
  app.add_option("--azimuth", view.azimuth_deg, "Where to look from, degrees: 0 = +x, 90 = +y")
      ->capture_default_str();
  app.add_option("--elevation", view.elevation_deg, "How steeply, degrees")
      ->check(CLI::Range(1.0, 89.0))
      ->capture_default_str();
  app.add_option("--width", view.width, "Pixels")
      ->check(CLI::Range(16, 8192))
      ->capture_default_str();
  app.add_option("--height", view.height, "Pixels")
      ->check(CLI::Range(16, 8192))
      ->capture_default_str();
  app.failure_message(nextview::what_is_wrong);
  app.set_version_flag("--version", "nextview_picture " + std::string(nextview::program_version()));
  CLI11_PARSE(app, argc, argv);
  try {
    draw_run(folder,
             file.empty() ? std::filesystem::path(folder) / "recovered.png"
                          : std::filesystem::path(file),
             views, occupied_only, nextview::cache_folder(cache), view);
  } catch (const std::exception& error) {
    std::cerr << "nextview_picture: " << error.what() << std::endl;
    return 1;
  }
  return 0;
}

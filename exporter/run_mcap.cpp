#include "exporter/run_mcap.h"

#include <algorithm>

#include "exporter/foxglove_json.h"
#include "exporter/mcap_writer.h"
#include "exporter/point_clouds.h"
#include "exporter/trajectory.h"
#include "mapper/mapper_config.h"

namespace nextview {
namespace {

const std::string kWorld = "world";
const std::string kSensor = "sensor";

// Maps of all views together hold no more voxels than this; beyond, every second view has one, or
// every third ..., and the last always.
constexpr std::int64_t kMostVoxels = 20'000'000;

std::vector<float> scan_values(const RangeImage& image) {
  std::vector<float> values;
  for_each_point(image, [&](const SensedPoint& point) {
    for (int axis = 0; axis < 3; ++axis) {
      values.push_back(static_cast<float>(point.position_m[axis]));
    }
    values.push_back(static_cast<float>((point.position_m - image.position_m).norm()));
  });
  return values;
}

std::vector<float> map_values(const VoxelMap& map) {
  std::vector<float> values;
  for_each_voxel(map.window(), [&](const VoxelIndex& voxel) {
    if (map.label(voxel) != Label::Occupied) return;
    const Eigen::Vector3d center_m = map.grid().center_m(voxel);
    for (int axis = 0; axis < 3; ++axis) values.push_back(static_cast<float>(center_m[axis]));
    const SurfaceVoxel* surface = map.surface(voxel);
    values.push_back(surface == nullptr ? 0.0F : static_cast<float>(surface->quality_01()));
  });
  return values;
}

// What is plotted of a view.
struct Figure {
  const char* name;
  double (*of)(const goal_t& goal, const commit_t& commit);
};
constexpr Figure kFigures[] = {
    {"view", [](const goal_t& goal, const commit_t&) { return double{1} * goal.view; }},
    {"fitness", [](const goal_t& goal, const commit_t&) { return goal.fitness; }},
    {"expected_gain_m2", [](const goal_t& goal, const commit_t&) { return goal.expected_gain_m2; }},
    {"evaluations",
     [](const goal_t& goal, const commit_t&) { return double{1} * goal.evaluations; }},
    {"mean_quality", [](const goal_t&, const commit_t& commit) { return commit.mean_quality; }},
    {"occupied_area_m2",
     [](const goal_t&, const commit_t& commit) { return commit.occupied_area_m2; }},
    {"occlusion_plane_area_m2",
     [](const goal_t&, const commit_t& commit) { return commit.occlusion_plane_area_m2; }}};

std::vector<std::string> figure_names() {
  std::vector<std::string> names;
  for (const Figure& figure : kFigures) names.emplace_back(figure.name);
  return names;
}

class RunTeller {
 public:
  RunTeller(std::ostream& out, const RecoveredRun& run)
      : run_(run),
        writer_(out),
        transform_(add("/tf", "foxglove.FrameTransform")),
        pose_(add("/sensor_pose", "foxglove.PoseInFrame")),
        scan_(add("/scan", "foxglove.PointCloud")),
        map_(add("/map", "foxglove.PointCloud")),
        path_(add("/path", "foxglove.SceneUpdate")),
        log_(add("/log", "foxglove.Log")),
        figures_(
            writer_.add_json_channel("/figures", "nextview.View",
                                     foxglove::schema_of_numbers("nextview.View", figure_names()))),
        builder_(grid_of(run.config()), window_of(run.config())) {}

  void tell() {
    const std::int64_t all =
        run_.builder.statistics().voxels[static_cast<std::size_t>(Label::Occupied)] *
        static_cast<std::int64_t>(run_.images.size());
    const std::int64_t stride = 1 + all / kMostVoxels;
    for (std::size_t i = 0; i < run_.images.size(); ++i) {
      const bool last = i + 1 == run_.images.size();
      tell_view(*run_.images[i], last || static_cast<std::int64_t>(i) % stride == 0);
    }
    if (const auto& stop = run_.log.record().stop(); stop && whole_run()) {
      say(now_ns_, stop->stop_reason + ": " + stop->detail);
    }
    writer_.finish();
  }

 private:
  std::uint16_t add(const std::string& topic, const std::string& schema) {
    return writer_.add_json_channel(topic, schema, foxglove::schema(schema));
  }
  void write(std::uint16_t channel, const foxglove::Json& message) {
    // A text may hold any bytes; those that are no UTF-8 become U+FFFD.
    writer_.write(channel, now_ns_,
                  message.dump(-1, ' ', false, foxglove::Json::error_handler_t::replace));
  }
  void say(std::uint64_t time_ns, const std::string& text) {
    write(log_, foxglove::log(time_ns, "nextview", text));
  }
  bool whole_run() const {
    return run_.log.record().committed_views() == static_cast<int>(run_.images.size());
  }

  void tell_view(const ReceivedRangeImage& received, bool with_map);

  const RecoveredRun& run_;
  McapWriter writer_;
  std::uint16_t transform_, pose_, scan_, map_, path_, log_, figures_;
  MapBuilder builder_;
  std::uint64_t now_ns_ = 0;
  std::vector<Eigen::Vector3d> line_m_;
  std::vector<Eigen::Isometry3d> arrows_;
};

void RunTeller::tell_view(const ReceivedRangeImage& received, bool with_map) {
  const RangeImage& image = received.image;
  const goal_t& goal = *run_.log.record().goal(received.view, received.attempt);
  const commit_t& commit = *run_.log.record().commit(received.view);
  now_ns_ = static_cast<std::uint64_t>(received.utime) * 1000;
  const Eigen::Quaterniond orientation =
      quaternion_of({received.view, 0.0, image.position_m, image.world_from_sensor});
  builder_.fold(image);

  write(transform_,
        foxglove::frame_transform(now_ns_, kWorld, kSensor, image.position_m, orientation));
  write(pose_, foxglove::pose_in_frame(now_ns_, kWorld, image.position_m, orientation));
  write(scan_,
        foxglove::point_cloud(now_ns_, kWorld, {"x", "y", "z", "range"}, scan_values(image)));
  if (with_map) {
    write(map_, foxglove::point_cloud(now_ns_, kWorld, {"x", "y", "z", "quality"},
                                      map_values(builder_.map())));
  }
  for (int i = 0; i < goal.waypoints; ++i) {
    const auto& waypoint = goal.waypoint_m[static_cast<std::size_t>(i)];
    line_m_.emplace_back(waypoint[0], waypoint[1], waypoint[2]);
  }
  // The sensor looks along its y axis, an arrow points along its x axis.
  Eigen::Isometry3d arrow = Eigen::Isometry3d::Identity();
  arrow.linear() =
      image.world_from_sensor *
      Eigen::AngleAxisd(std::numbers::pi / 2.0, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  arrow.translation() = image.position_m;
  arrows_.push_back(arrow);
  write(path_, foxglove::path_and_arrows(now_ns_, kWorld, line_m_, arrows_));
  say(now_ns_, "view " + std::to_string(received.view) + ": " +
                   (goal.reason.empty() ? "the scan at the start" : goal.reason));
  foxglove::Json figures = {{"timestamp", foxglove::time(now_ns_)}};
  for (const Figure& figure : kFigures) figures[figure.name] = figure.of(goal, commit);
  write(figures_, figures);
}

}  // namespace

void write_run_mcap(std::ostream& out, const RecoveredRun& run) { RunTeller(out, run).tell(); }

}  // namespace nextview

#include "reports/search_report.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numbers>
#include <stdexcept>
#include <string>

#include "sensor/sensor_pose.h"

namespace nextview {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kDegreesPerRad = 180.0 / std::numbers::pi;

Json json_of(const Eigen::Vector3d& vector) { return {vector.x(), vector.y(), vector.z()}; }

/// The sensed points of an image (eq. 1).
Json points_of(const RangeImage& image) {
  Json points = Json::array();
  const RangeBounds bounds(image.limits);
  std::size_t pixel = 0;
  for (int v = 0; v < image.rays.rows(); ++v) {
    for (int u = 0; u < image.rays.columns(); ++u, ++pixel) {
      if (bounds.kind_of(image.range_m[pixel]) != RangeKind::Point) continue;
      points.push_back(
          json_of(image.position_m + static_cast<double>(image.range_m[pixel]) *
                                         (image.world_from_sensor * image.rays.ray(u, v))));
    }
  }
  return points;
}

/// As nextview_search_t.lcm numbers them.
const char* name_of_move(int move) {
  constexpr const char* kNames[] = {"first_vertex", "initial",        "reflection",
                                    "expansion",    "contraction_1d", "contraction_3d",
                                    "lattice",      "lattice_refined"};
  return move >= 0 && move < 8 ? kNames[move] : "other";
}

Json tried_of(const search_t& search) {
  Json tried = Json::array();
  for (std::size_t i = 0; i < static_cast<std::size_t>(search.tried); ++i) {
    const auto& position = search.tried_position_m[i];
    tried.push_back({{"position_m", {position[0], position[1], position[2]}},
                     {"direction", json_of(viewing_direction(search.tried_pan_rad[i],
                                                             search.tried_tilt_rad[i]))},
                     {"fitness", search.tried_fitness[i]},
                     {"move", name_of_move(search.tried_move[i])}});
  }
  return tried;
}

template <class Message>
const Message& there(const Message* message, const char* what, int view) {
  if (message != nullptr) return *message;
  throw std::invalid_argument("the log has no " + std::string(what) + " of view " +
                              std::to_string(view));
}

/// The attempt that arrived and was scanned.
int attempt_of(const RunRecord& record, int view) {
  return there(record.commit(view), "committed range image", view).attempt;
}

}  // namespace

void write_search(std::ostream& out, const RunRecord& record, int view) {
  if (!record.config()) throw std::invalid_argument("the log has no run's configuration");
  if (view < 2) throw std::invalid_argument("view 1 is the scan at the start: nothing is searched");
  const int attempt = attempt_of(record, view);
  const int before = attempt_of(record, view - 1);
  const search_t& search = there(record.search(view, attempt), "search", view);
  const goal_t& goal = there(record.goal(view, attempt), "goal", view);
  const RangeImage& image =
      there(record.range_image(view - 1, before), "range image", view - 1).image;
  const run_config_t& config = *record.config();

  Json json;
  json["scene"] = config.scene_name;
  json["seed"] = config.seed;
  json["strategy"] = config.strategy;
  json["quality"] = config.planner.quality_weight > 0.0;
  json["view"] = view;
  json["workspace_min_m"] = config.base.workspace_min_m;
  json["workspace_max_m"] = config.base.workspace_max_m;
  json["from_m"] = json_of(image.position_m);
  json["goal"] = {{"position_m", goal.position_m},
                  {"pan_deg", goal.pan_rad * kDegreesPerRad},
                  {"tilt_deg", goal.tilt_rad * kDegreesPerRad},
                  {"fitness", goal.fitness},
                  {"evaluations", goal.evaluations}};
  json["tried"] = tried_of(search);
  json["points_m"] = points_of(image);
  out << json.dump(-1, ' ', false, Json::error_handler_t::replace) << '\n';
}

int largest_search(const RunRecord& record, int last_view) {
  int largest = 0;
  int most = 0;
  for (int view = 2; view <= std::min(last_view, record.committed_views()); ++view) {
    const commit_t* commit = record.commit(view);
    const search_t* search = commit ? record.search(view, commit->attempt) : nullptr;
    if (search == nullptr || search->tried <= most) continue;
    largest = view;
    most = search->tried;
  }
  return largest;
}

}  // namespace nextview

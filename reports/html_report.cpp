#include "reports/html_report.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include "logger/message_fields.h"
#include "logger/recovered_run.h"
#include "mapper/mapper_config.h"
#include "reports/base64.h"
#include "reports/page_files.h"
#include "reports/picture_file.h"

namespace nextview {
namespace {

using Json = nlohmann::ordered_json;

/// Larger range images are thinned out for the page.
constexpr int kDepthColumns = 64;
constexpr int kDepthRows = 48;

/// JSON has no infinity and no NaN.
Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

template <class Value>
Json json_of(const Value& value) {
  if constexpr (std::is_floating_point_v<Value>) {
    return number(value);
  } else if constexpr (std::is_arithmetic_v<Value> || std::is_same_v<Value, std::string>) {
    return Json(value);
  } else {
    Json list = Json::array();
    for (const auto& item : value) list.push_back(json_of(item));
    return list;
  }
}

/// Every field of the configuration, by the name of its .lcm file.
Json settings_of(const run_config_t& config) {
  Json settings = Json::object();
  for_each_field<run_config_t>(
      [&](const std::string& name, const auto& get) { settings[name] = json_of(get(config)); });
  return settings;
}

Json read_summary(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in) return nullptr;
  Json summary = Json::parse(in, nullptr, false);
  return summary.is_discarded() ? Json(nullptr) : summary;
}

/// surface_coverage by view, as views.csv has it.
std::vector<std::string> coverage_column(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::vector<std::string> values;
  std::size_t column = std::string::npos;
  for (std::string line; std::getline(in, line);) {
    std::istringstream cells(line);
    std::string cell;
    for (std::size_t i = 0; std::getline(cells, cell, ','); ++i) {
      if (column == std::string::npos && cell == "surface_coverage") {
        column = i;
        break;
      }
      if (i == column) values.push_back(cell);
    }
    if (column == std::string::npos) break;
  }
  return values;
}

Json views_of(const RunRecord& record, const std::vector<std::string>& coverage) {
  Json views = Json::array();
  double path_m = 0.0;
  for (const auto& [view, commit] : record.commits()) {
    const goal_t* goal = record.goal(view, commit.attempt);
    const arrival_t* arrival = record.arrival(view, commit.attempt);
    if (arrival != nullptr) path_m += arrival->path_length_m;
    const auto plan_s = record.duration_s(view, commit.attempt, "plan");
    const auto at = static_cast<std::size_t>(view - 1);
    Json row = {{"view", view},
                {"attempt", commit.attempt},
                {"x", commit.used_position_m[0]},
                {"y", commit.used_position_m[1]},
                {"z", commit.used_position_m[2]},
                {"pan_rad", commit.pan_rad},
                {"tilt_rad", commit.tilt_rad},
                {"simulated_s", static_cast<double>(commit.utime) * 1e-6},
                {"path_m", path_m},
                {"mean_quality", commit.mean_quality},
                {"occupied_area_m2", commit.occupied_area_m2},
                {"occlusion_plane_area_m2", commit.occlusion_plane_area_m2},
                {"points", commit.points},
                {"no_returns", commit.no_returns},
                {"map_digest", commit.map_digest}};
    row["surface_coverage"] = at < coverage.size() && !coverage[at].empty()
                                  ? Json(std::stod(coverage[at]))
                                  : Json(nullptr);
    row["plan_ms"] = plan_s ? Json(1e3 * *plan_s) : Json(nullptr);
    if (goal != nullptr && view > 1) {
      row["fitness"] = goal->fitness;
      row["evaluations"] = goal->evaluations;
      row["expected_gain_m2"] = goal->expected_gain_m2;
      row["reason"] = goal->reason;
    }
    Json waypoints = Json::array();
    for (int i = 0; goal != nullptr && i < goal->waypoints; ++i) {
      waypoints.push_back(json_of(goal->waypoint_m[static_cast<std::size_t>(i)]));
    }
    row["waypoints"] = waypoints;
    views.push_back(row);
  }
  return views;
}

/// Refusals of the base, of all attempts.
Json refusals_of(const RunRecord& record) {
  Json refusals = Json::array();
  for (const auto& [key, arrival] : record.arrivals()) {
    if (arrival.arrived == 0) {
      refusals.push_back({{"view", key.view}, {"attempt", key.attempt}, {"why", arrival.refusal}});
    }
  }
  return refusals;
}

/// Little-endian.
template <class Number>
void append(std::vector<unsigned char>& bytes, Number value) {
  for (std::size_t byte = 0; byte < sizeof value; ++byte) {
    bytes.push_back(static_cast<unsigned char>(static_cast<std::uint64_t>(value) >> (8 * byte)));
  }
}

/// The view after which each slot's voxel became Occupied; 0: never.
std::vector<std::uint16_t> occupied_since(const RecoveredRun& run) {
  MapBuilder builder(grid_of(run.config()), window_of(run.config()));
  std::vector<std::uint16_t> since(builder.map().labels().size(), 0);
  for (const ReceivedRangeImage* received : run.images) {
    for (const std::uint32_t slot : builder.fold(received->image).changed_slots) {
      if (builder.map().labels()[slot] == Label::Occupied) {
        since[slot] = static_cast<std::uint16_t>(std::min(received->view, 0xffff));
      }
    }
  }
  return since;
}

/// The faces of Occupied voxels that touch an Empty one, ten bytes each: i, j, k from the window's
/// first voxel and the view since which the voxel is Occupied, 16 bits each; the side (+x, -x, +y,
/// -y, +z, -z) and the quality in 1/255.
Json surface_of(const RecoveredRun& run) {
  const VoxelMap& map = run.builder.map();
  const std::vector<std::uint16_t> since = occupied_since(run);
  std::vector<unsigned char> faces;
  for_each_voxel(map.window(), [&](const VoxelIndex& voxel) {
    if (map.label(voxel) != Label::Occupied) return;
    const SurfaceVoxel* surface = map.surface(voxel);
    const double quality = surface == nullptr ? 0.0 : surface->quality_01();
    for (int side = 0; side < 6; ++side) {
      const VoxelIndex step = (side % 2 == 0 ? 1 : -1) * VoxelIndex::Unit(side / 2);
      if (map.label(voxel + step) != Label::Empty) continue;
      for (int axis = 0; axis < 3; ++axis) {
        append(faces, static_cast<std::uint16_t>(voxel[axis] - map.window().min[axis]));
      }
      append(faces, since[map.slot(voxel)]);
      append(faces, static_cast<std::uint8_t>(side));
      append(faces, static_cast<std::uint8_t>(std::lround(255.0 * quality)));
    }
  });
  const Eigen::Vector3d first_m = map.grid().center_m(map.window().min);
  return {{"voxel_size_m", map.grid().voxel_size_m},
          {"first_m", {first_m.x(), first_m.y(), first_m.z()}},
          {"faces", base64(faces)}};
}

/// Range images as pictures of depth, a byte a pixel: 0 no valid range, 255 no return, else near
/// (1) to far (254) within what the run has met.
Json depth_of(const RecoveredRun& run) {
  float farthest_m = 0.0F;
  for (const ReceivedRangeImage* received : run.images) {
    const RangeBounds bounds(received->image.limits);
    for (const float range_m : received->image.range_m) {
      if (bounds.kind_of(range_m) == RangeKind::Point) farthest_m = std::max(farthest_m, range_m);
    }
  }
  Json images = Json::array();
  for (const ReceivedRangeImage* received : run.images) {
    const RangeImage& image = received->image;
    const RangeBounds bounds(image.limits);
    const int columns = std::min(image.rays.columns(), kDepthColumns);
    const int rows = std::min(image.rays.rows(), kDepthRows);
    std::vector<unsigned char> bytes;
    for (int v = 0; v < rows; ++v) {
      for (int u = 0; u < columns; ++u) {
        const int row = v * image.rays.rows() / rows;
        const int column = u * image.rays.columns() / columns;
        const float range_m =
            image.range_m[static_cast<std::size_t>(row * image.rays.columns() + column)];
        switch (bounds.kind_of(range_m)) {
          case RangeKind::Point:
            bytes.push_back(
                static_cast<unsigned char>(1 + std::lround(253.0F * range_m / farthest_m)));
            break;
          case RangeKind::NoReturn:
            bytes.push_back(255);
            break;
          case RangeKind::Invalid:
            bytes.push_back(0);
            break;
        }
      }
    }
    images.push_back({{"columns", columns}, {"rows", rows}, {"bytes", base64(bytes)}});
  }
  return {{"farthest_m", farthest_m}, {"images", images}};
}

std::string picture_of(const RecoveredRun& run) {
  std::vector<SensorPose> poses;
  for (const ReceivedRangeImage* received : run.images) poses.push_back(received->image.pose);
  PictureView view;
  view.width = 960;
  view.height = 600;
  return base64(png_bytes(recovered_picture(run.builder.map(), {poses, {}, {}}, view), {}));
}

std::string name_of(const std::filesystem::path& folder_or_log) {
  const std::filesystem::path absolute =
      std::filesystem::weakly_canonical(std::filesystem::absolute(folder_or_log));
  return absolute.filename().string();
}

}  // namespace

Json report_data(const std::filesystem::path& folder_or_log) {
  const std::filesystem::path file = log_file_of(folder_or_log);
  RunLog log(file, std::nullopt, RangeImages::OnlyCount);
  log.read_on();
  const RunRecord& record = log.record();
  if (!record.config()) throw LogError(file.string() + ": no run's configuration is in the log");
  const std::filesystem::path folder = file.parent_path();
  Json data;
  data["name"] = name_of(folder_or_log);
  data["settings"] = settings_of(*record.config());
  data["summary"] = read_summary(folder / "summary.json");
  const std::optional<stop_t>& stop = record.stop();
  data["stop"] = {{"reason", stop ? stop->stop_reason : "no end"},
                  {"detail", stop ? stop->detail : "The log says of no end of the run."}};
  data["views"] = views_of(record, coverage_column(folder / "views.csv"));
  data["refusals"] = refusals_of(record);
  Json missing = Json::array();
  for (const MissingMessage& message : record.missing()) missing.push_back(describe(message));
  data["log"] = {{"messages", log.counters().messages},
                 {"ours", log.counters().ours},
                 {"foreign", log.counters().foreign},
                 {"repeated", log.counters().repeated},
                 {"dropped", log.dropped()},
                 {"contradictions", log.contradictions()},
                 {"missing", missing},
                 {"bytes_left", log.bytes_left()}};
  try {
    const RecoveredRun run = recover_run(folder_or_log);
    data["surface"] = surface_of(run);
    data["depth"] = depth_of(run);
    data["picture"] = picture_of(run);
  } catch (const std::exception& error) {
    // The page still says what stopped the run.
    data["no_map"] = error.what();
  }
  return data;
}

void write_html_report(std::ostream& out, const std::vector<Json>& runs) {
  std::string text = Json(runs).dump(-1, ' ', false, Json::error_handler_t::replace);
  // Inside a script element nothing may look like its end.
  for (std::size_t at = 0; (at = text.find("</", at)) != std::string::npos; at += 3) {
    text.replace(at, 2, "<\\/");
  }
  const std::string title =
      runs.size() == 1 ? runs[0]["name"].get<std::string>() : std::to_string(runs.size()) + " runs";
  std::string safe_title;
  for (const char c : title)
    safe_title += std::string_view("<>&\"").find(c) == std::string::npos ? c : '_';
  out << "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
         "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; "
         "script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data:\">\n<title>"
      << safe_title << " \xE2\x80\x93 nextview</title>\n<style>\n"
      << kPageStyle << "</style>\n</head>\n<body>\n"
      << kPageBody << "<script type=\"application/json\" id=\"runs\">" << text
      << "</script>\n<script>\n"
      << kPageScript << "</script>\n</body>\n</html>\n";
}

}  // namespace nextview

#include "reports/search_report.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>

#include "sensor/range_image_message.h"
#include "tests/lcmtypes/examples.h"

namespace nextview {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();

/// From (1, 2, 3), turned by 90 degrees to the left: sensor +y is world -x. One row of three rays,
/// the middle one straight ahead.
RangeImage three_rays() {
  RangeImage image;
  image.position_m = {1.0, 2.0, 3.0};
  image.world_from_sensor = Eigen::Matrix3d{{0, -1, 0}, {1, 0, 0}, {0, 0, 1}};
  image.rays.column_sin = {0.6, 0.0, -0.6};
  image.rays.column_cos = {0.8, 1.0, 0.8};
  image.rays.row_sin = {0.0};
  image.rays.row_cos = {1.0};
  image.range_m = {5.0F, 2.0F, kInf};
  return image;
}

/// View 1 as above, and view 2, for which `tried` positions were tried.
RunRecord two_views(int tried = 2) {
  RunRecord record(RangeImages::Keep);
  auto config = example<run_config_t>();
  config.planner.quality_weight = 1.0;
  config.sensor.columns = 3;
  config.sensor.rows = 1;
  record.add(config);
  for (const range_image_t& part : range_image_messages(three_rays(), 1, 1, 0)) record.add(part);
  auto commit = example<commit_t>();
  commit.view = 1;
  record.add(commit);
  auto search = example<search_t>();
  search.tried = tried;
  search.tried_position_m.resize(static_cast<std::size_t>(tried), {0.0, 0.0, 0.0});
  search.tried_pan_rad.resize(static_cast<std::size_t>(tried));
  search.tried_tilt_rad.resize(static_cast<std::size_t>(tried));
  search.tried_fitness.resize(static_cast<std::size_t>(tried));
  search.tried_move.resize(static_cast<std::size_t>(tried));
  record.add(search);
  record.add(example<goal_t>());
  commit.view = 2;
  record.add(commit);
  return record;
}

nlohmann::json search_of(const RunRecord& record, int view) {
  std::ostringstream out;
  write_search(out, record, view);
  return nlohmann::json::parse(out.str());
}

TEST(SearchReport, SaysWhatWasTriedAndFromWhere) {
  const nlohmann::json json = search_of(two_views(), 2);
  EXPECT_EQ(json.at("scene"), "room");
  EXPECT_EQ(json.at("seed"), 3);
  EXPECT_EQ(json.at("strategy"), "paper");
  EXPECT_EQ(json.at("quality"), true);
  EXPECT_EQ(json.at("view"), 2);
  EXPECT_EQ(json.at("from_m"), nlohmann::json({1.0, 2.0, 3.0}));
  EXPECT_EQ(json.at("workspace_max_m"), nlohmann::json({3.0, 3.0, 3.0}));
  EXPECT_EQ(json.at("goal").at("fitness"), 0.9);
  ASSERT_EQ(json.at("tried").size(), 2u);
  EXPECT_LT(json.at("tried")[0].at("fitness"), 0.0) << "not feasible";
  EXPECT_EQ(json.at("tried")[0].at("move"), "first_vertex");
  const nlohmann::json& second = json.at("tried")[1];
  EXPECT_EQ(second.at("position_m"), nlohmann::json({1.0, 0.0, 0.0}));
  EXPECT_EQ(second.at("move"), "contraction_3d");
  // Pan 1 rad, tilt 0.5 rad.
  EXPECT_NEAR(second.at("direction")[0].get<double>(), -std::sin(1.0) * std::cos(0.5), 1e-12);
  EXPECT_NEAR(second.at("direction")[1].get<double>(), std::cos(1.0) * std::cos(0.5), 1e-12);
  EXPECT_NEAR(second.at("direction")[2].get<double>(), std::sin(0.5), 1e-12);
}

TEST(SearchReport, GivesTheSensedPointsInTheWorld) {
  const nlohmann::json points = search_of(two_views(), 2).at("points_m");
  ASSERT_EQ(points.size(), 2u) << "the third ray met nothing";
  // Ray (-0.6, 0.8, 0) of 5 m is (-3, 4, 0) of the sensor, (-4, -3, 0) of the world.
  const double expected[2][3] = {{-3.0, -1.0, 3.0}, {-1.0, 2.0, 3.0}};
  for (std::size_t i = 0; i < 2; ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(points[i][axis].get<double>(), expected[i][axis], 1e-6) << i << ' ' << axis;
    }
  }
}

TEST(SearchReport, NamesWhatIsMissing) {
  const auto says = [](const RunRecord& record, int view, const std::string& words) {
    std::ostringstream out;
    try {
      write_search(out, record, view);
      ADD_FAILURE() << "nothing was missing";
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
    }
    EXPECT_EQ(out.str(), "");
  };
  says(two_views(), 1, "view 1 is the scan at the start");
  says(two_views(), 3, "no committed range image of view 3");
  says(RunRecord(RangeImages::Keep), 2, "no run's configuration");
}

TEST(SearchReport, FindsTheLargestSearch) {
  EXPECT_EQ(largest_search(two_views(), 15), 2);
  EXPECT_EQ(largest_search(two_views(), 1), 0);
  EXPECT_EQ(largest_search(two_views(0), 15), 0) << "nothing was tried";

  RunRecord record = two_views(2);
  auto commit = example<commit_t>();
  auto search = example<search_t>();
  for (int view = 3; view <= 4; ++view) {  // three each: the first of them is the largest
    search.view = commit.view = view;
    search.tried = 3;
    search.tried_position_m.assign(3, {0.0, 0.0, 0.0});
    record.add(search);
    record.add(commit);
  }
  EXPECT_EQ(largest_search(record, 15), 3);
  EXPECT_EQ(largest_search(record, 2), 2);
}

}  // namespace
}  // namespace nextview

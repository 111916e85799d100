#include "reports/run_report.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>

#include "reports/progress.h"

namespace nextview {
namespace {

constexpr char kDigest[] = "0123456789abcdef0123456789abcdef";

/// Two views: the start, and one that was decided on in 4 ms.
FinishedRun two_views() {
  FinishedRun run;
  run.config.scene_name = "box";
  run.config.seed = 5;
  run.config.planner.max_views = 2;
  run.stop_detail = "Enough.";
  run.first_goal_to_last_commit_s = 0.02;
  for (int view = 1; view <= 2; ++view) {
    ViewRow row;
    row.view = view;
    row.goal.view = view;
    row.goal.attempt = 1;
    row.goal.fitness = 0.75;
    row.goal.iterations = 6;
    row.goal.evaluations = 9;
    if (view == 2) row.plan_s = row.first_plan_s = 0.004;
    row.arrival.path_length_m = view == 1 ? 0.0 : 1.5;
    row.commit.pan_rad = std::numbers::pi / 2.0;
    row.commit.map_digest = kDigest;
    row.commit.mean_quality = 0.5;
    row.update_s = 0.003;
    if (view == 2) row.surface_coverage = 0.25;
    run.rows.push_back(row);
  }
  return run;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

TEST(Views, AreOneRowEach) {
  std::ostringstream out;
  write_views(out, two_views());
  const auto lines = lines_of(out.str());
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_TRUE(lines[0].starts_with(
      "view,x_m,y_m,z_m,pan_deg,tilt_deg,fitness,iterations,evaluations,plan_s,mean_quality,"
      "occupied_area_m2,occlusion_plane_area_m2,surface_coverage,map_digest,"));
  EXPECT_TRUE(lines[1].starts_with(
      "1,0.000000,0.000000,0.000000,90.0000,0.0000,,,,,0.500000,0.0000,0.0000,," +
      std::string(kDigest) + ","))
      << lines[1];
  EXPECT_TRUE(lines[2].starts_with(
      "2,0.000000,0.000000,0.000000,90.0000,0.0000,0.75,6,9,0.004000,0.500000,0.0000,0.0000,"
      "0.250000," +
      std::string(kDigest) + ","))
      << lines[2];
  for (const std::string& line : lines) {
    EXPECT_EQ(std::count(line.begin(), line.end(), ','),
              std::count(lines[0].begin(), lines[0].end(), ','));
  }
}

TEST(Views, AreBlankWhereATimingWasLost) {
  FinishedRun run = two_views();
  run.rows[1].plan_s.reset();
  run.rows[1].wait_s = 0.5;
  std::ostringstream out;
  write_views(out, run);
  const auto lines = lines_of(out.str());
  EXPECT_NE(lines[2].find(",0.75,6,9,,0.500000,"), std::string::npos) << lines[2];
  EXPECT_TRUE(lines[2].ends_with(",,,0.003000,,,0.500000,,,")) << lines[2];
}

// Quality stands where it always has; the others stand last, blank where they do not count.
TEST(Views, HaveTheFactorsThatCount) {
  FinishedRun run = two_views();
  run.config.strategy = "paper";
  for (ViewRow& row : run.rows) {
    row.goal.factor_names = "quality,structure,navigation";
    row.goal.factor_value = {0.25, 0.5, 0.125};
  }
  const auto ends_of_rows = [&run] {
    std::ostringstream out;
    write_views(out, run);
    std::vector<std::string> ends;
    for (const std::string& line : lines_of(out.str())) {
      const std::size_t last = line.rfind(',');
      ends.push_back(line.substr(line.rfind(',', last - 1)));
    }
    return ends;
  };
  using Ends = std::vector<std::string>;
  EXPECT_EQ(ends_of_rows(), (Ends{",structure_factor,navigation_factor", ",,", ",,"}));
  run.config.planner.navigation_weight = 2.0;
  EXPECT_EQ(ends_of_rows()[2], ",,0.125000");
  run.config.planner.structure_weight = 1.0;
  EXPECT_EQ(ends_of_rows()[2], ",0.500000,0.125000");
  EXPECT_EQ(ends_of_rows()[1], ",,") << "the start was not decided on";
  std::ostringstream out;
  write_views(out, run);
  EXPECT_NE(lines_of(out.str())[2].find(",0.250000,,,"), std::string::npos);
}

TEST(Summary, SaysHowTheRunEnded) {
  FinishedRun run = two_views();
  run.collisions = 1;
  run.stop_reason = "nothing_new";
  run.map_memory_bytes = 750000;
  std::ostringstream out;
  write_summary(out, run);
  const auto json = nlohmann::json::parse(out.str());
  EXPECT_EQ(json.at("scene"), "box");
  EXPECT_EQ(json.at("seed"), 5);
  EXPECT_EQ(json.at("views"), 2);
  EXPECT_EQ(json.at("stop_reason"), "nothing_new");
  EXPECT_EQ(json.at("surface_coverage"), 0.25);
  EXPECT_EQ(json.at("path_length_m"), 1.5);
  EXPECT_EQ(json.at("collisions"), 1);
  EXPECT_EQ(json.at("plan_s_median"), 0.004) << "the start was not decided on";
  EXPECT_EQ(json.at("map_digest"), kDigest);
  EXPECT_EQ(json.at("map_memory_bytes"), 750000);
}

TEST(Summary, CountsAsBusAndWaitingWhatNoStageOnTheLongestWayTakes) {
  FinishedRun run = two_views();
  for (ViewRow& row : run.rows) row.fold_s = 0.001;
  run.rows[1].move_s = 0.001;
  run.rows[1].scan_s = 0.001;
  const auto share = [&run] {
    std::ostringstream out;
    write_summary(out, run);
    return nlohmann::json::parse(out.str()).at("bus_and_waiting_share").get<double>();
  };
  // Of 20 ms: 1 + 4 of fold and plan beside 3 of update, 2 on the way to the next, 3 of update.
  EXPECT_NEAR(share(), 0.5, 1e-12);
  // An update longer than fold and plan is what the goal waits for.
  run.rows[0].update_s = 0.007;
  EXPECT_NEAR(share(), 0.4, 1e-12);
  // What follows a refusal is beside nothing.
  run.rows[1].refused_s = 0.002;
  EXPECT_NEAR(share(), 0.3, 1e-12);
}

TEST(Summary, OfARunWithoutViewsIsWholeToo) {
  FinishedRun run;
  run.stop_reason = "interrupted";
  std::ostringstream out;
  write_summary(out, run);
  const auto json = nlohmann::json::parse(out.str());
  EXPECT_EQ(json.at("views"), 0);
  EXPECT_TRUE(json.at("surface_coverage").is_null());
}

TEST(Summary, OfASceneWhoseNameIsNoUtf8IsJson) {
  FinishedRun run = two_views();
  run.config.scene_file = "/home/fran\xe7ois/salle.obj";
  std::ostringstream out;
  write_summary(out, run);
  EXPECT_EQ(nlohmann::json::parse(out.str()).at("scene_file"),
            "/home/fran\xef\xbf\xbdois/salle.obj");
}

TEST(Summary, SaysWhyThereIsNoCoverage) {
  FinishedRun run = two_views();
  run.rows.back().surface_coverage.reset();
  run.coverage_unknown = "nobody looked";
  std::ostringstream out;
  write_summary(out, run);
  const auto json = nlohmann::json::parse(out.str());
  EXPECT_TRUE(json.at("surface_coverage").is_null());
  EXPECT_EQ(json.at("surface_coverage_unknown"), "nobody looked");
  std::ostringstream table;
  write_table(table, run);
  EXPECT_NE(table.str().find("unknown, because nobody looked"), std::string::npos) << table.str();
}

TEST(Views, EndOnThePrecisionAndTheFactors) {
  FinishedRun run = two_views();
  run.rows[1].surface_precision = 0.75;
  std::ostringstream out;
  write_views(out, run);
  const auto lines = lines_of(out.str());
  EXPECT_TRUE(lines[0].ends_with(",wait_s,surface_precision,structure_factor,navigation_factor"))
      << lines[0];
  EXPECT_TRUE(lines[1].ends_with(",,,")) << lines[1];
  EXPECT_TRUE(lines[2].ends_with(",0.750000,,")) << lines[2];
}

TEST(Summary, HasThePrecisionOrSaysWhyNot) {
  FinishedRun run = two_views();
  run.rows[1].surface_precision = 0.75;
  const auto summary_of = [](const FinishedRun& finished) {
    std::ostringstream out;
    write_summary(out, finished);
    return nlohmann::json::parse(out.str());
  };
  const auto table_of = [](const FinishedRun& finished) {
    std::ostringstream out;
    write_table(out, finished);
    return out.str();
  };
  EXPECT_EQ(summary_of(run).at("surface_precision"), 0.75);
  EXPECT_FALSE(summary_of(run).contains("surface_precision_unknown"));
  EXPECT_NE(table_of(run).find("surface precision     0.750 of Occupied"), std::string::npos)
      << table_of(run);
  run.rows[1].surface_precision.reset();
  run.precision_unknown = "nobody looked";
  EXPECT_TRUE(summary_of(run).at("surface_precision").is_null());
  EXPECT_EQ(summary_of(run).at("surface_precision_unknown"), "nobody looked");
  EXPECT_NE(table_of(run).find("surface precision     unknown, because nobody looked"),
            std::string::npos)
      << table_of(run);
}

/// The run of two views, of which the second reaches 96 %, and a bound for 95 and 99 %.
FinishedRun bounded() {
  FinishedRun run = two_views();
  run.rows[1].surface_coverage = 0.96;
  run.bound_command = "nextview_bound box";
  run.bounds = {{.share = 0.95,
                 .reached = true,
                 .greedy_views = 16,
                 .greedy_m = 12.5,
                 .fewest_views = 11,
                 .shortest_m = 0.75},
                {.share = 0.99}};
  return run;
}

std::string last_line_of_table(const FinishedRun& run) {
  std::ostringstream out;
  write_table(out, run);
  return lines_of(out.str()).back();
}

TEST(Bound, EndsTheTable) {
  FinishedRun run = bounded();
  EXPECT_EQ(last_line_of_table(run),
            "  95 % in 2 views, greedy who knows the scene 16, no planner can below 11");
  run.rows[1].surface_coverage = 0.94;
  EXPECT_EQ(
      last_line_of_table(run),
      "  95 % not reached in 2 views, greedy who knows the scene 16, no planner can below 11");
  run.rows[1].surface_coverage.reset();
  run.coverage_unknown = "nobody looked";
  EXPECT_EQ(last_line_of_table(run),
            "  95 % unknown, greedy who knows the scene 16, no planner can below 11");
  run.bounds[0].reached = false;
  EXPECT_EQ(last_line_of_table(run),
            "  95 % unknown, not even with all views from everywhere reachable");
}

TEST(Bound, ThatIsNotKnownNamesTheCommandThatTells) {
  FinishedRun run = bounded();
  run.bounds.clear();
  EXPECT_EQ(last_line_of_table(run), "  how few views it could be says: nextview_bound box");
  std::ostringstream out;
  write_summary(out, run);
  const auto json = nlohmann::json::parse(out.str());
  EXPECT_TRUE(json.at("bounds").is_null());
  EXPECT_EQ(json.at("bounds_unknown"), "they have not been worked out: nextview_bound box");
  run.bound_command.clear();
  EXPECT_TRUE(last_line_of_table(run).starts_with("  map digest")) << "without a scene";
}

TEST(Bound, IsInTheSummary) {
  std::ostringstream out;
  write_summary(out, bounded());
  const auto json = nlohmann::json::parse(out.str()).at("bounds");
  ASSERT_EQ(json.size(), 2u);
  EXPECT_EQ(json[0].at("surface_coverage"), 0.95);
  EXPECT_EQ(json[0].at("views"), 2);
  EXPECT_EQ(json[0].at("path_length_m"), 1.5);
  EXPECT_EQ(json[0].at("can_be_reached"), true);
  EXPECT_EQ(json[0].at("greedy_views"), 16);
  EXPECT_EQ(json[0].at("greedy_path_length_m"), 12.5);
  EXPECT_EQ(json[0].at("least_views"), 11);
  EXPECT_EQ(json[0].at("least_path_length_m"), 0.75);
  EXPECT_TRUE(json[1].at("views").is_null());
  EXPECT_TRUE(json[1].at("path_length_m").is_null());
  EXPECT_EQ(json[1].at("can_be_reached"), false);
  EXPECT_FALSE(json[1].contains("greedy_views"));
}

TEST(Summary, CountsCollisionsApartFromOtherRefusals) {
  FinishedRun run = two_views();
  run.collisions = 1;
  run.other_refusals = 2;
  std::ostringstream out;
  write_summary(out, run);
  EXPECT_EQ(nlohmann::json::parse(out.str()).at("collisions"), 1);
  EXPECT_EQ(nlohmann::json::parse(out.str()).at("other_refusals"), 2);
}

TEST(Progress, IsOneLineAView) {
  std::ostringstream out;
  Progress progress(out, Progress::Style::Lines, 2);
  for (const ViewRow& row : two_views().rows) progress.show(row);
  progress.say("something else");
  progress.finish();
  EXPECT_EQ(out.str(),
            "view   1/2  coverage unknown  quality 0.500  start\n"
            "view   2/2  coverage 0.250  quality 0.500  decided in 4.0 ms\n"
            "something else\n");
}

TEST(Progress, OnATerminalIsABarOnOneLine) {
  std::ostringstream out;
  Progress progress(out, Progress::Style::Bar, 2);
  const FinishedRun run = two_views();
  progress.show(run.rows[0]);
  EXPECT_EQ(out.str().find('\n'), std::string::npos);
  EXPECT_NE(out.str().find("[###############...............] view   1/2"), std::string::npos);
  progress.say("something else");
  progress.show(run.rows[1]);
  progress.finish();
  EXPECT_NE(out.str().find("\033[Ksomething else\n"), std::string::npos);
  EXPECT_NE(out.str().find("[##############################] view   2/2"), std::string::npos);
  EXPECT_TRUE(out.str().ends_with("\n"));
}

}  // namespace
}  // namespace nextview

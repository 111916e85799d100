#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/system/program.h"

namespace nextview {
namespace {

std::string first_line(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  return line;
}

TEST(WholeRun, OfTenViewsCompletes) {
  const TemporaryFolder folder;
  const Outcome outcome = run_views(folder / "run", 10);
  ASSERT_EQ(outcome.status, 0) << outcome.output;
  EXPECT_NE(outcome.output.find("view  10/10"), std::string::npos) << outcome.output;
  EXPECT_NE(outcome.output.find((folder / "run" / "run.lcmlog").string()), std::string::npos);

  EXPECT_TRUE(first_line(folder / "run" / "views.csv")
                  .starts_with("view,x_m,y_m,z_m,pan_deg,tilt_deg,fitness,iterations,evaluations,"
                               "plan_s,mean_quality,occupied_area_m2,occlusion_plane_area_m2,"
                               "surface_coverage,map_digest"));
  const auto views = column_of_views(folder / "run", "view");
  ASSERT_EQ(views.size(), 10u);
  EXPECT_EQ(views.front(), "1");
  EXPECT_EQ(views.back(), "10");
  EXPECT_EQ(column_of_views(folder / "run", "fitness").front(), "") << "nobody chose the start";
  for (const std::string& digest : column_of_views(folder / "run", "map_digest")) {
    EXPECT_EQ(digest.size(), 32u);
  }

  const nlohmann::json summary = summary_of(folder / "run");
  EXPECT_EQ(summary.at("scene"), "boxes");
  EXPECT_EQ(summary.at("seed"), 1);
  EXPECT_EQ(summary.at("views"), 10);
  EXPECT_EQ(summary.at("stop_reason"), "view_limit");
  EXPECT_EQ(summary.at("collisions"), 0);
  EXPECT_GT(summary.at("surface_coverage").get<double>(), 0.1);
  EXPECT_LT(summary.at("surface_coverage").get<double>(), 1.0);
  EXPECT_EQ(summary.at("map_digest"), column_of_views(folder / "run", "map_digest").back());
  for (const char* name :
       {"mean_quality", "occupied_area_m2", "path_length_m", "plan_s_median", "wall_s"}) {
    EXPECT_GT(summary.at(name).get<double>(), 0.0) << name;
  }
  for (const char* role : {"sensor_sim", "base_sim", "mapper", "planner", "lcm-logger", "run"}) {
    EXPECT_GT(summary.at("peak_memory_bytes").at(role).get<double>(), 1e6) << role;
  }
}

TEST(WholeRun, CoversMoreWithEveryView) {
  const TemporaryFolder folder;
  ASSERT_EQ(run_views(folder / "run", 15).status, 0);
  double before = 0.0;
  for (const std::string& text : column_of_views(folder / "run", "surface_coverage")) {
    const double coverage = std::stod(text);
    EXPECT_GE(coverage, before);
    before = coverage;
  }
  EXPECT_GT(before, 0.3);
}

TEST(WholeRun, EndsByItsStopRule) {
  const TemporaryFolder folder;
  // More than 89 m2 of new surface cannot come, so the rule holds as soon as it is asked, and the
  // run goes on only as long as a good view can be reached.
  const Outcome outcome = run_views(folder / "run", 300,
                                    {"--strategy", "paper", "--stop-window", "4", "--stop-new-area",
                                     "1000", "--voxel-size", "0.2"});
  ASSERT_EQ(outcome.status, 0) << outcome.output;
  const nlohmann::json summary = summary_of(folder / "run");
  EXPECT_EQ(summary.at("stop_reason"), "nothing_new");
  EXPECT_GT(summary.at("views"), 5) << "four views after the one at the start much is unseen";
  EXPECT_LT(summary.at("views"), 300);
  EXPECT_GT(summary.at("surface_coverage"), 0.95);
  const std::string detail = summary.at("stop_detail");
  EXPECT_NE(detail.find("a view has a fitness above 0.6"), std::string::npos) << detail;
}

TEST(WholeRun, EndsWhenNothingIsLeftAndReplays) {
  const TemporaryFolder folder;
  const Outcome outcome = run_views(folder / "run", 60);
  ASSERT_EQ(outcome.status, 0) << outcome.output;
  EXPECT_NE(outcome.output.find("of boundary left unseen"), std::string::npos) << outcome.output;
  const nlohmann::json summary = summary_of(folder / "run");
  EXPECT_EQ(summary.at("stop_reason"), "nothing_left");
  EXPECT_LE(summary.at("views").get<int>(), 45);
  EXPECT_GE(summary.at("surface_coverage").get<double>(), 0.998);
  EXPECT_EQ(summary.at("collisions"), 0);
  const Outcome replay = replay_folder(folder / "run", {"--planner"});
  EXPECT_EQ(replay.status, 0) << replay.output;
  EXPECT_NE(replay.output.find("every one the same"), std::string::npos) << replay.output;
}

TEST(WholeRun, EndsOnTheBoundOnceItIsKept) {
  const TemporaryFolder folder;
  const std::vector<std::string> question = {"--cache",         (folder / "cache").string(),
                                             "--bound-spacing", "1.5",
                                             "--voxel-size",    "0.25",
                                             "--columns",       "24",
                                             "--rows",          "12"};
  const Outcome before = run_views(folder / "before", 2, question);
  ASSERT_EQ(before.status, 0) << before.output;
  EXPECT_NE(before.output.find("how few views it could be says: " + program_path("nextview_bound") +
                               " --views 2 --cache "),
            std::string::npos)
      << before.output;
  EXPECT_TRUE(summary_of(folder / "before").at("bounds").is_null());

  std::vector<std::string> bound = {program_path("nextview_bound")};
  bound.insert(bound.end(), question.begin(), question.end());
  const Outcome worked_out = run_program(bound);
  ASSERT_EQ(worked_out.status, 0) << worked_out.output;
  EXPECT_NE(worked_out.output.find("no planner below"), std::string::npos) << worked_out.output;

  const Outcome after = run_views(folder / "after", 2, question);
  ASSERT_EQ(after.status, 0) << after.output;
  EXPECT_NE(after.output.find("\n  95 % not reached in 2 views, greedy who knows the scene "),
            std::string::npos)
      << after.output;
  const nlohmann::json bounds = summary_of(folder / "after").at("bounds");
  ASSERT_EQ(bounds.size(), 2u);
  EXPECT_TRUE(bounds[0].at("views").is_null());
  EXPECT_GE(bounds[0].at("greedy_views").get<int>(), bounds[0].at("least_views").get<int>());
  EXPECT_GT(bounds[0].at("least_views").get<int>(), 2);
  EXPECT_GE(bounds[1].at("least_views").get<int>(), bounds[0].at("least_views").get<int>());
}

TEST(WholeRun, FallsShortOfPrecisionWithNoise) {
  const TemporaryFolder folder;
  const auto precision_of = [&](const std::string& noise_m) {
    const Outcome outcome =
        run_views(folder / noise_m, 5, {"--no-coverage", "--range-noise-m", noise_m});
    EXPECT_EQ(outcome.status, 0) << outcome.output;
    return summary_of(folder / noise_m).at("surface_precision").get<double>();
  };
  EXPECT_EQ(precision_of("0"), 1.0);
  EXPECT_LT(precision_of("0.2"), 0.95);
}

TEST(WholeRun, WithQualityRepeatsAndReplays) {
  const TemporaryFolder folder;
  ASSERT_EQ(run_views(folder / "run", 6, {"--quality", "--range-noise-m", "0.01"}).status, 0);
  const Outcome replay = replay_folder(folder / "run", {"--planner"});
  EXPECT_EQ(replay.status, 0) << replay.output;
  EXPECT_NE(replay.output.find("6 views replayed"), std::string::npos) << replay.output;
  EXPECT_NE(replay.output.find("5 goals decided again"), std::string::npos) << replay.output;
}

TEST(WholeRun, SendsLargeRangeImagesInParts) {
  const TemporaryFolder folder;
  // 400 x 200 pixels of 4 bytes: six messages of at most 60 KB each.
  ASSERT_EQ(run_views(folder / "run", 3, {"--columns", "400", "--rows", "200"}).status, 0);
  const Outcome replay = replay_folder(folder / "run");
  EXPECT_EQ(replay.status, 0) << replay.output;
}

TEST(WholeRun, RecoversTheSharedScenes) {
  const auto scenes = std::filesystem::path(NEXTVIEW_SOURCE_DIR) / ".." / "shared" / "scenes";
  if (!std::filesystem::exists(scenes)) {
    GTEST_SKIP() << scenes << " is not there, so no scene of others is tried";
  }
  for (const char* name : {"conference", "small_house", "cpr_office"}) {
    const TemporaryFolder folder;
    // Their coverage takes up to minutes; that of our own rooms is tested above.
    const Outcome outcome =
        run_views(folder / "run", 2, {(scenes / name).string(), "--no-coverage"});
    EXPECT_EQ(outcome.status, 0) << outcome.output;
    EXPECT_TRUE(summary_of(folder / "run").at("surface_coverage").is_null());
    EXPECT_EQ(summary_of(folder / "run").at("scene"), name);
    EXPECT_EQ(replay_folder(folder / "run").status, 0);
  }
}

}  // namespace
}  // namespace nextview

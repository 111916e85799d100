#include "planner/view_planner.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include "sensor/range_image.h"

namespace nextview {
namespace {

/// A strategy that goes where it is told, and remembers what it was asked.
class Scripted : public Strategy {
 public:
  struct Asked {
    int view;
    int attempt;
    std::size_t refused;
    std::int64_t empty_voxels;  // in the space it was given
  };
  struct Log {
    std::vector<Asked> asked;
    std::vector<std::int64_t> folded;  // newly Occupied, by view
    std::optional<Ending> ending;
  };
  explicit Scripted(Log& log) : log_(log) {}

  KnownSpace::Surfaces surfaces() const override { return KnownSpace::Surfaces::Leave; }
  void view_folded(const FoldedView& folded) override {
    EXPECT_EQ(folded.view, static_cast<int>(log_.folded.size()) + 1);
    log_.folded.push_back(folded.report.newly_occupied);
  }
  std::optional<Ending> ending() const override { return log_.ending; }
  NextView next_view(const Situation& situation) override {
    std::int64_t empty = 0;
    const MapWindow& window = situation.space.map().window();
    for (int i = 0; i < window.size[0]; ++i) {
      const VoxelIndex voxel = window.min + VoxelIndex(i, window.size[1] / 2, window.size[2] / 2);
      empty += situation.space.field().free_distance(voxel) > 0;
    }
    log_.asked.push_back({situation.view, situation.attempt, situation.refused.size(), empty});
    Decision decision;
    decision.pose = situation.present;
    decision.pose.pan_rad += 0.1 * situation.attempt;
    return decision;
  }

 private:
  Log& log_;
};

/// A wall three metres ahead, looked at along +y from a place in the middle of the window.
RangeImage wall_ahead(double x_m) {
  RangeImage image;
  image.rays = make_ray_table(TiltedLineScan::with_aperture(16, 8, 1.0));
  image.pose = {{x_m, 0.0, 0.0}, 0.0, 0.0};
  image.position_m = image.pose.position_m;
  image.world_from_sensor = Eigen::Matrix3d::Identity();
  for (int v = 0; v < image.rays.rows(); ++v) {
    for (int u = 0; u < image.rays.columns(); ++u) {
      image.range_m.push_back(static_cast<float>(3.0 / image.rays.ray(u, v).y()));
    }
  }
  return image;
}

class PlansViews : public ::testing::Test {
 protected:
  ViewPlanner::Parameters parameters_;
  Scripted::Log log_;
  ViewPlanner planner(int max_views = 60) {
    parameters_.max_views = max_views;
    return {{0.1, Eigen::Vector3d::Zero()},
            {VoxelIndex(-40, -40, -20), VoxelIndex(80, 80, 40)},
            std::make_unique<Scripted>(log_),
            parameters_};
  }
};

TEST_F(PlansViews, DecidesOnceAViewUntilRefused) {
  ViewPlanner planner = this->planner();
  EXPECT_THROW(planner.next_view(), std::logic_error);
  EXPECT_THROW(planner.refuse(), std::logic_error);
  planner.fold(wall_ahead(0.0));
  EXPECT_THROW(planner.refuse(), std::logic_error);
  const NextView first = planner.next_view();
  planner.next_view();
  ASSERT_EQ(log_.asked.size(), 1U);
  EXPECT_EQ(log_.asked[0].view, 2);
  EXPECT_EQ(log_.asked[0].attempt, 1);
  planner.refuse();
  EXPECT_EQ(planner.attempt(), 2);
  planner.next_view();
  ASSERT_EQ(log_.asked.size(), 2U);
  EXPECT_EQ(log_.asked[1].attempt, 2);
  EXPECT_EQ(log_.asked[1].refused, 1U);

  planner.fold(wall_ahead(0.5));
  planner.next_view();
  EXPECT_EQ(planner.views(), 2);
  EXPECT_EQ(log_.asked[2].view, 3);
  EXPECT_EQ(log_.asked[2].attempt, 1);
  EXPECT_EQ(log_.asked[2].refused, 0U);
}

// Several folds may come before a decision is asked for; the space has followed them all.
TEST_F(PlansViews, GivesTheStrategyASpaceThatHasFollowedEveryFold) {
  ViewPlanner planner = this->planner();
  planner.fold(wall_ahead(0.0));
  planner.next_view();
  planner.fold(wall_ahead(1.0));
  planner.fold(wall_ahead(-1.0));
  planner.next_view();
  ASSERT_EQ(log_.folded.size(), 3U);
  EXPECT_GT(log_.folded[0], 0);
  ASSERT_EQ(log_.asked.size(), 2U);
  EXPECT_GT(log_.asked[1].empty_voxels, log_.asked[0].empty_voxels);
  const KnownSpace fresh(planner.map());
  for (int i = -40; i < 40; ++i) {
    for (int j = -40; j < 40; ++j) {
      ASSERT_EQ(planner.space().field().at({i, j, 0}), fresh.field().at({i, j, 0}));
    }
  }
}

TEST_F(PlansViews, EndsAsTheStrategySaysAndElseAtTheViewLimit) {
  ViewPlanner planner = this->planner(2);
  planner.fold(wall_ahead(0.0));
  EXPECT_TRUE(std::holds_alternative<Decision>(planner.next_view()));
  planner.fold(wall_ahead(0.1));
  ASSERT_TRUE(std::holds_alternative<Ending>(planner.next_view()));
  EXPECT_EQ(std::get<Ending>(planner.next_view()).reason, StopReason::ViewLimit);
  EXPECT_THROW(planner.refuse(), std::logic_error);
  log_.ending = Ending{StopReason::NothingNew, "enough"};
  planner.fold(wall_ahead(0.2));
  EXPECT_EQ(std::get<Ending>(planner.next_view()).reason, StopReason::NothingNew);
}

TEST_F(PlansViews, AnImageThatCannotBeRightChangesNothing) {
  ViewPlanner planner = this->planner();
  planner.fold(wall_ahead(0.0));
  const std::string digest = planner.builder().digest();
  RangeImage wrong = wall_ahead(0.5);
  wrong.range_m.pop_back();
  EXPECT_THROW(planner.fold(wrong), std::invalid_argument);
  EXPECT_EQ(planner.views(), 1);
  EXPECT_EQ(planner.builder().digest(), digest);
  EXPECT_TRUE(std::holds_alternative<Decision>(planner.next_view()));
}

TEST_F(PlansViews, ParametersThatCannotBeAreNamed) {
  EXPECT_THROW(this->planner(0), std::invalid_argument);
  parameters_.threads = 0;
  EXPECT_THROW(this->planner(), std::invalid_argument);
}

}  // namespace
}  // namespace nextview

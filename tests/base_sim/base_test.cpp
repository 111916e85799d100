#include "base_sim/base.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "scene/brute_force_scene.h"
#include "scene/scene_catalog.h"
#include "tests/scene/test_worlds.h"

namespace nextview {
namespace {

constexpr double kPi = std::numbers::pi;
using Path = std::vector<Eigen::Vector3d>;

// A room of 4 x 3 x 2 m, x in [-2, 2], y in [-1, 2], z in [0, 2], with a wall across it at x = 0.5
// from y = 0 on, and a closed case of 1 m3 at x in [-1.9, -0.9], y in [0.9, 1.9], z in [0.1, 1.1].
TriangleMesh room_with_wall() {
  TriangleMesh mesh = load_mesh(kDataFolder / "room.obj");
  const auto add_quad = [&](const std::array<Eigen::Vector3f, 4>& corners) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices_m.size());
    mesh.vertices_m.insert(mesh.vertices_m.end(), corners.begin(), corners.end());
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first, first + 2, first + 3});
  };
  add_quad({Eigen::Vector3f(0.5F, 0, 0), {0.5F, 2, 0}, {0.5F, 2, 2}, {0.5F, 0, 2}});
  const Eigen::Vector3f low(-1.9F, 0.9F, 0.1F);
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3f u = Eigen::Vector3f::Unit((axis + 1) % 3);
    const Eigen::Vector3f v = Eigen::Vector3f::Unit((axis + 2) % 3);
    for (const Eigen::Vector3f& corner :
         {low, Eigen::Vector3f(low + Eigen::Vector3f::Unit(axis))}) {
      add_quad({corner, corner + u, corner + u + v, corner + v});
    }
  }
  return mesh;
}

BaseLimits limits() {
  BaseLimits limits;
  limits.workspace_min_m = {-1.8, -0.8, 0.0};
  limits.workspace_max_m = {1.8, 1.8, 2.0};
  limits.lift_min_m = 0.3;
  limits.lift_max_m = 1.7;
  limits.base_speed_m_s = 0.5;
  limits.lift_speed_m_s = 0.1;
  limits.turn_speed_rad_s = 0.4;
  limits.body_radius_m = 0.2;
  return limits;
}

class BaseTest : public ::testing::Test {
 protected:
  // A move that must be refused: names why, and leaves everything as it was.
  std::string refusal(const Path& waypoints, const SensorPose& goal) {
    const SensorPose before = base_.pose();
    const Motion motion = base_.move(waypoints, goal);
    EXPECT_FALSE(motion.arrived);
    EXPECT_EQ(motion.duration_s, 0.0);
    EXPECT_EQ(motion.path_length_m, 0.0);
    for (const SensorPose& after : {motion.pose, base_.pose()}) {
      EXPECT_EQ(after.position_m, before.position_m);
      EXPECT_EQ(after.pan_rad, before.pan_rad);
      EXPECT_EQ(after.tilt_rad, before.tilt_rad);
    }
    return motion.refusal;
  }

  const Eigen::Vector3d start_{-0.5, -0.5, 1.0};
  Scene scene_{room_with_wall()};
  Base base_{limits(), {start_, 0.0, 0.0}, scene_};
};

void expect_says(const std::string& message, const std::string& part) {
  EXPECT_NE(message.find(part), std::string::npos) << message;
}

TEST_F(BaseTest, MovesAlongThePathToTheGoal) {
  const SensorPose goal{{1.5, 1.0, 1.0}, 0.3, -0.2};
  const Motion motion = base_.move(Path{start_, {1.5, -0.5, 1.0}, goal.position_m}, goal);
  EXPECT_TRUE(motion.arrived) << motion.refusal;
  EXPECT_TRUE(motion.refusal.empty());
  EXPECT_DOUBLE_EQ(motion.path_length_m, 2.0 + 1.5);
  EXPECT_DOUBLE_EQ(motion.duration_s, 3.5 / 0.5);
  EXPECT_EQ(motion.pose.position_m, goal.position_m);
  EXPECT_EQ(base_.pose().position_m, goal.position_m);
  EXPECT_EQ(base_.pose().pan_rad, 0.3);
  EXPECT_EQ(base_.pose().tilt_rad, -0.2);
}

TEST_F(BaseTest, EveryPieceTakesAsLongAsTheSlowerOfBaseAndLift) {
  const SensorPose goal{{-0.5, -0.5, 1.5}, 0.0, 0.0};
  // Piece 1: 0.5 m across (1 s) and 0.3 m up (3 s); piece 2: back (1 s) and 0.2 m up (2 s).
  const Motion motion = base_.move(Path{start_, {0.0, -0.5, 1.3}, goal.position_m}, goal);
  EXPECT_TRUE(motion.arrived) << motion.refusal;
  EXPECT_NEAR(motion.duration_s, 3.0 + 2.0, 1e-9);
}

TEST_F(BaseTest, TurnsMeanwhileAndTheShortWayRound) {
  SensorPose goal{start_, 3.0, 0.0};
  EXPECT_DOUBLE_EQ(base_.move(Path{start_}, goal).duration_s, 3.0 / 0.4);
  goal.pan_rad = -3.0;  // 6 rad the long way, 2 pi - 6 the short way
  EXPECT_NEAR(base_.move(Path{start_}, goal).duration_s, (2.0 * kPi - 6.0) / 0.4, 1e-12);
  goal.tilt_rad = 1.0;
  EXPECT_DOUBLE_EQ(base_.move(Path{start_}, goal).duration_s, 1.0 / 0.4);
  // 1 m across takes 2 s, longer than the turn by 0.4 rad.
  goal = {{-1.5, -0.5, 1.0}, -2.6, 1.0};
  EXPECT_DOUBLE_EQ(base_.move(Path{start_, goal.position_m}, goal).duration_s, 2.0);
}

TEST_F(BaseTest, RefusesAPathThroughAWall) {
  const SensorPose goal{{1.5, -0.5, 1.0}, 0.0, 0.0};
  const std::string why =
      refusal({start_, {-0.5, 0.5, 1.0}, {1.5, 0.5, 1.0}, goal.position_m}, goal);
  // The sphere of 0.2 m touches the wall at x = 0.5 when its centre is at 0.3.
  expect_says(why, "touch a surface at (0.300, 0.500, 1.000)");
  expect_says(why, "leaves 0.000 m of the 0.200 m");
}

TEST_F(BaseTest, RefusesAPathTooNearAWallByHowMuch) {
  const SensorPose goal{{0.35, 1.0, 1.0}, 0.0, 0.0};
  expect_says(refusal({start_, goal.position_m}, goal), "leaves 0.150 m of the 0.200 m");
  // Past the free end of the wall, at (0.5, 0), with 0.1 m to spare and then without.
  const SensorPose beyond{{1.5, -0.3, 1.0}, 0.0, 0.0};
  EXPECT_TRUE(base_.move(Path{start_, {-0.5, -0.3, 1.0}, beyond.position_m}, beyond).arrived);
  const SensorPose back{{-0.5, -0.15, 1.0}, 0.0, 0.0};
  expect_says(refusal({beyond.position_m, {1.5, -0.15, 1.0}, back.position_m}, back),
              "leaves 0.150 m of the 0.200 m");
}

TEST_F(BaseTest, RefusesWhatIsOutOfReachByHowMuch) {
  const auto to = [&](const Eigen::Vector3d& position_m) {
    return refusal({start_, position_m}, {position_m, 0.0, 0.0});
  };
  expect_says(to({-1.85, -0.5, 1.0}), "0.050 m outside the workspace, whose x");
  expect_says(to({-0.5, -0.9, 1.0}), "0.100 m outside the workspace, whose y");
  expect_says(to({-0.5, -0.5, 1.75}), "0.050 m beyond the lift");
  expect_says(to({-0.5, -0.5, 0.2}), "0.100 m beyond the lift");
  expect_says(to({std::nan(""), 0, 1}), "not finite");
  expect_says(refusal({start_, {-1.9, -0.5, 1.0}, start_}, {start_, 0.0, 0.0}), "workspace");
}

TEST_F(BaseTest, RefusesAnglesItCannotTurnTo) {
  expect_says(refusal({start_}, {start_, 0.0, kPi / 2.0 + 0.01}), "beyond +-90");
  expect_says(refusal({start_}, {start_, 0.0, -kPi / 2.0 - 0.01}), "beyond +-90");
  expect_says(refusal({start_}, {start_, std::nan(""), 0.0}), "not finite");
  EXPECT_TRUE(base_.move(Path{start_}, {start_, 0.0, kPi / 2.0}).arrived);
}

TEST_F(BaseTest, RefusesAPathThatDoesNotLeadFromHereToTheGoal) {
  const SensorPose goal{{-1.0, -0.5, 1.0}, 0.0, 0.0};
  expect_says(refusal({}, goal), "no waypoints");
  expect_says(refusal({{-0.6, -0.5, 1.0}, goal.position_m}, goal),
              "0.100 m from the present position");
  expect_says(refusal({start_, {-0.8, -0.5, 1.0}}, goal), "0.200 m from the goal");
}

// Thousands of straight pieces: refused exactly where brute force says the body would touch.
TEST_F(BaseTest, RefusesExactlyWhereBruteForceSaysTheBodyTouches) {
  const BruteForceScene plain(room_with_wall());
  RandomStream random = random_stream(1);
  int arrived = 0;
  int refused = 0;
  for (int i = 0; i < 4000; ++i) {
    const Eigen::Vector3d from = base_.pose().position_m;
    const Eigen::Vector3d to =
        Eigen::Vector3d(0, 0.5, 1) +
        random_point(random, 1.0).cwiseProduct(Eigen::Vector3d(1.8, 1.3, .7));
    const bool is_clear = plain.clearance_m(from, to, 0.2) >= 0.2;
    EXPECT_EQ(base_.move(Path{from, to}, {to, 0.0, 0.0}).arrived, is_clear);
    ++(is_clear ? arrived : refused);
  }
  EXPECT_GT(arrived, 400);
  EXPECT_GT(refused, 400);
}

std::string start_failure(const BaseLimits& limits, const SensorPose& start, const Scene& scene) {
  try {
    const Base base(limits, start, scene);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "no invalid_argument";
}

TEST_F(BaseTest, RefusesStartsThatCannotBe) {
  const auto at = [&](const Eigen::Vector3d& position_m) {
    return start_failure(limits(), {position_m, 0.0, 0.0}, scene_);
  };
  expect_says(at({0.6, 1.0, 1.0}),
              "start position (0.600, 1.000, 1.000): too near a surface, 0.100 m");
  expect_says(at({-1.4, 1.4, 0.6}), "inside an obstacle");
  expect_says(at({1.9, 0.0, 1.0}), "outside the workspace");
  expect_says(at({0.0, 0.0, 0.1}), "beyond the lift");
  expect_says(start_failure(limits(), {start_, 0.0, 2.0}, scene_), "tilt");
  BaseLimits wide = limits();
  wide.workspace_max_m.x() = 9.0;
  expect_says(start_failure(wide, {{5.0, 0.0, 1.0}, 0.0, 0.0}, scene_), "outside the scene");
}

TEST_F(BaseTest, RefusesLimitsThatCannotBe) {
  const auto with = [&](const std::function<void(BaseLimits&)>& change) {
    BaseLimits changed = limits();
    change(changed);
    return start_failure(changed, {start_, 0.0, 0.0}, scene_);
  };
  expect_says(with([](BaseLimits& l) { l.workspace_max_m.y() = -0.8; }), "workspace");
  expect_says(with([](BaseLimits& l) { l.workspace_min_m.y() = std::nan(""); }), "workspace");
  expect_says(with([](BaseLimits& l) { l.lift_max_m = 0.3; }), "lift");
  expect_says(with([](BaseLimits& l) { l.base_speed_m_s = 0.0; }), "speed");
  expect_says(with([](BaseLimits& l) { l.lift_speed_m_s = -1.0; }), "speed");
  expect_says(with([](BaseLimits& l) { l.turn_speed_rad_s = HUGE_VAL; }), "speed");
  expect_says(with([](BaseLimits& l) { l.body_radius_m = std::nan(""); }), "body_radius_m = nan");
}

TEST(BaseInOurRooms, StartsWhereTheySayAndNotInsideObstacles) {
  for (const char* name : {"boxes", "columns"}) {
    const SceneDescription description = find_scene(name, kScenesFolder);
    const Scene scene(load_mesh(description.file, description.options));
    BaseLimits room;
    room.workspace_min_m = scene.mesh().bounds_m().min();
    room.workspace_max_m = scene.mesh().bounds_m().max();
    EXPECT_NO_THROW(Base(room, {description.start_m.value(), 0.0, 0.0}, scene)) << name;
    // In the crate and in the first column, neither of which has a bottom.
    const Eigen::Vector3d inside = name == std::string("boxes") ? Eigen::Vector3d(1.9, 1.5, 1.0)
                                                                : Eigen::Vector3d(1.55, 1.45, 1.0);
    expect_says(start_failure(room, {inside, 0.0, 0.0}, scene), "inside an obstacle");
  }
}

}  // namespace
}  // namespace nextview

// What the strategies recover of our own rooms in at most 60 views.

#include <gtest/gtest.h>

#include <iostream>
#include <string>

#include "scoring/kept_file.h"
#include "scoring/surface_coverage.h"
#include "sensor/sensor_config.h"
#include "tests/system/explored_room.h"

namespace nextview {
namespace {

constexpr int kViews = 60;

/// The surface coverage of a run with the default options.
double coverage(const std::string& room, const std::string& strategy, std::int64_t seed) {
  const RunSetup setup = room_setup(room, strategy, seed, kViews);
  SurfaceCoverage recovered;
  double share = 0.0;
  const VisibleSurface visible =
      kept_visible_surface(cache_folder({}), *setup.scene, std::string(setup.config.scene_digest),
                           start_pose_of(setup.config).position_m, visibility_of(setup.config));
  explore(setup, [&](const ViewPlanner& planner, const FoldReport& fold, const RangeImage&) {
    if (planner.views() == 1) recovered.set_visible(planner.map(), visible);
    recovered.add_view(planner.map(), fold);
    share = recovered.after_view(planner.views()).value();
  });
  return share;
}

/// What the seeds from 1 on have to come to, the mean and each of them.
struct Room {
  std::string name;
  std::string strategy;
  int seeds;
  double least_mean;
  double least;
};

void PrintTo(const Room& room, std::ostream* out) {
  *out << room.name << ", strategy " << room.strategy;
}

std::string name_of(const testing::TestParamInfo<Room>& info) { return info.param.name; }

class RecoveredRoom : public testing::TestWithParam<Room> {};

TEST_P(RecoveredRoom, InSixtyViews) {
  const Room& room = GetParam();
  double sum = 0.0;
  for (int seed = 1; seed <= room.seeds; ++seed) {
    const double share = coverage(room.name, room.strategy, seed);
    EXPECT_GE(share, room.least) << "seed " << seed;
    std::cout << room.name << ", " << room.strategy << ", seed " << seed << ": " << share << "\n";
    sum += share;
  }
  EXPECT_GE(sum / room.seeds, room.least_mean);
}

// It recovers at least 0.997 of either room on every seed tried, and ends by itself before.
INSTANTIATE_TEST_SUITE_P(BySurface, RecoveredRoom,
                         testing::Values(Room{"boxes", "surface", 3, 0.995, 0.995},
                                         Room{"columns", "surface", 3, 0.995, 0.995}),
                         name_of);

// The simplex method depends on where its draws begin, so no three seeds say much: it is the mean
// of ten that is held, and each seed to less.
INSTANTIATE_TEST_SUITE_P(AsThePaperHasIt, RecoveredRoom,
                         testing::Values(Room{"boxes", "paper", 10, 0.97, 0.95},
                                         Room{"columns", "paper", 10, 0.955, 0.935}),
                         name_of);

}  // namespace
}  // namespace nextview

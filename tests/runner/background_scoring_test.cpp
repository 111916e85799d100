#include "runner/background_scoring.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>

namespace nextview {
namespace {

constexpr std::chrono::milliseconds kLong{60000};

TEST(BackgroundScoring, GivesWhatWasWorkedOutOnce) {
  BackgroundScoring<VisibleSurface> scoring([](const std::stop_token&, WorkProgress*) {
    VisibleSurface surface;
    surface.samples = 7;
    return surface;
  });
  const auto surface = scoring.take(kLong);
  ASSERT_TRUE(surface);
  EXPECT_EQ(surface->samples, 7);
  EXPECT_FALSE(scoring.pending());
  EXPECT_FALSE(scoring.take(kLong));
  EXPECT_EQ(scoring.failure(), "");
}

TEST(BackgroundScoring, ThatFailsSaysWhyAndHarmsNobody) {
  BackgroundScoring<VisibleSurface> scoring(
      [](const std::stop_token&, WorkProgress*) -> VisibleSurface {
        throw std::runtime_error("no room for the positions");
      });
  EXPECT_FALSE(scoring.take(kLong));
  EXPECT_FALSE(scoring.pending());
  EXPECT_EQ(scoring.failure(), "it could not be worked out: no room for the positions");
}

TEST(BackgroundScoring, SurvivesWhatIsNoException) {
  BackgroundScoring<VisibleSurface> scoring(
      [](const std::stop_token&, WorkProgress*) -> VisibleSurface { throw 1; });
  EXPECT_FALSE(scoring.take(kLong));
  EXPECT_EQ(scoring.failure(), "it could not be worked out");
}

TEST(BackgroundScoring, EndsWhenAskedToAndSaysHowFarItIs) {
  std::atomic<bool> half_done = false;
  BackgroundScoring<VisibleSurface> scoring(
      [&half_done](const std::stop_token& stop, WorkProgress* progress) {
        progress->of = 40;
        progress->done = 20;
        half_done = true;
        half_done.notify_one();
        while (!stop.stop_requested()) std::this_thread::yield();
        return VisibleSurface{};
      });
  half_done.wait(false);
  EXPECT_EQ(scoring.percent(), 50);
  EXPECT_FALSE(scoring.take(std::chrono::milliseconds(1)));
  EXPECT_TRUE(scoring.pending());
  scoring.request_stop();
  EXPECT_TRUE(scoring.take(kLong));
}

// As when a run is interrupted while its scene is still being looked at.
TEST(BackgroundScoring, IsNotWaitedForWhenItIsDropped) {
  std::atomic<bool> stopped = false;
  {
    const BackgroundScoring<VisibleSurface> scoring(
        [&stopped](const std::stop_token& stop, WorkProgress*) {
          while (!stop.stop_requested()) std::this_thread::yield();
          stopped = true;
          return VisibleSurface{};
        });
  }
  EXPECT_TRUE(stopped);
}

}  // namespace
}  // namespace nextview

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "runner/port_lock.h"
#include "tests/system/program.h"

namespace nextview {
namespace {

using Column = std::vector<std::string>;

Column digests_of(const std::filesystem::path& folder) {
  return column_of_views(folder, "map_digest");
}

/// Keeps every core busy as long as it exists.
class CpuHog {
 public:
  CpuHog() {
    for (unsigned i = 0; i < 2 * std::max(1u, std::thread::hardware_concurrency()); ++i) {
      threads_.emplace_back([](const std::stop_token& stop) {
        std::atomic<std::uint64_t> count = 0;
        while (!stop.stop_requested()) ++count;
      });
    }
  }

 private:
  std::vector<std::jthread> threads_;
};

TEST(Repeat, TheSameSeedGivesTheSameRun) {
  const TemporaryFolder folder;
  ASSERT_EQ(run_views(folder / "a", 10, {"--seed", "7"}).status, 0);
  ASSERT_EQ(run_views(folder / "b", 10, {"--seed", "7"}).status, 0);
  ASSERT_EQ(digests_of(folder / "a").size(), 10u);
  EXPECT_EQ(digests_of(folder / "a"), digests_of(folder / "b"));
  for (const char* column :
       {"x_m", "y_m", "z_m", "pan_deg", "tilt_deg", "fitness", "evaluations", "surface_coverage"}) {
    EXPECT_EQ(column_of_views(folder / "a", column), column_of_views(folder / "b", column));
  }
}

TEST(Repeat, TheSameSeedGivesTheSameRunBesideACpuHog) {
  const TemporaryFolder folder;
  ASSERT_EQ(run_views(folder / "alone", 10, {"--range-noise-m", "0.01"}).status, 0);
  {
    const CpuHog hog;
    const Outcome outcome = run_views(folder / "hog", 10, {"--range-noise-m", "0.01"});
    ASSERT_EQ(outcome.status, 0) << outcome.output;
  }
  EXPECT_EQ(digests_of(folder / "alone"), digests_of(folder / "hog"));
}

TEST(Repeat, AnotherSeedGivesAnotherRun) {
  const TemporaryFolder folder;
  ASSERT_EQ(run_views(folder / "a", 4, {"--seed", "1"}).status, 0);
  ASSERT_EQ(run_views(folder / "b", 4, {"--seed", "2"}).status, 0);
  EXPECT_EQ(digests_of(folder / "a").front(), digests_of(folder / "b").front())
      << "without noise the scan at the start depends on no seed";
  EXPECT_NE(digests_of(folder / "a").back(), digests_of(folder / "b").back());
}

TEST(Repeat, TwoRunsAtOnceDoNotDisturbEachOther) {
  const TemporaryFolder folder;
  ASSERT_EQ(run_views(folder / "alone", 20).status, 0);
  Program a(run_arguments(folder / "a", 20));
  Program b(run_arguments(folder / "b", 20));
  EXPECT_EQ(a.wait(), 0) << a.output();
  EXPECT_EQ(b.wait(), 0) << b.output();
  EXPECT_EQ(digests_of(folder / "a"), digests_of(folder / "alone"));
  EXPECT_EQ(digests_of(folder / "b"), digests_of(folder / "alone"));
}

TEST(Repeat, NotEvenOnTheSamePort) {
  const TemporaryFolder folder;
  ASSERT_EQ(run_views(folder / "alone", 10).status, 0);
  const PortLock port = PortLock::acquire();
  const std::vector<std::string> same_port = {"--lcm-url", port.lcm_url()};
  Program a(run_arguments(folder / "a", 10, same_port));
  Program b(run_arguments(folder / "b", 10, same_port));
  EXPECT_EQ(a.wait(), 0) << a.output();
  EXPECT_EQ(b.wait(), 0) << b.output();
  EXPECT_EQ(digests_of(folder / "a"), digests_of(folder / "alone"));
  EXPECT_EQ(digests_of(folder / "b"), digests_of(folder / "alone"));
}

}  // namespace
}  // namespace nextview

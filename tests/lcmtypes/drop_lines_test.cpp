#include "lcmtypes/drop_lines.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

namespace nextview {
namespace {

using Clock = DropLines::Clock;

TEST(DropLines, SaysEachWhileThereAreFewAndThenTheirSum) {
  std::ostringstream out;
  const Clock::time_point start = Clock::now();
  DropLines lines("mapper", out);
  for (int i = 0; i < 1000; ++i) lines.say("NEXTVIEW_GOAL", "view 0", 1, start);
  lines.say("", "a fragment", 7, start);
  std::string said = out.str();
  EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), DropLines::kAtOnce);
  EXPECT_TRUE(said.starts_with("mapper: dropped a message on NEXTVIEW_GOAL: view 0\n")) << said;

  lines.tell_sum_when_due(start);
  EXPECT_EQ(out.str(), said) << "too soon";
  lines.tell_sum_when_due(start + DropLines::kAfterwards);
  EXPECT_EQ(out.str().substr(said.size()),
            "mapper: dropped more like these: 7, 990 on NEXTVIEW_GOAL\n");
  said = out.str();
  lines.tell_sum_when_due(start + 5 * DropLines::kAfterwards);
  EXPECT_EQ(out.str(), said) << "there is nothing more to say";
}

TEST(DropLines, SaysTheRestAtItsEnd) {
  std::ostringstream out;
  {
    const Clock::time_point start = Clock::now();
    DropLines lines("run", out);
    for (int i = 0; i <= DropLines::kAtOnce; ++i) lines.say("NEXTVIEW_STOP", "no", 1, start);
  }
  EXPECT_TRUE(out.str().ends_with("run: dropped more like these: 1 on NEXTVIEW_STOP\n"))
      << out.str();
}

TEST(DropLines, OfAnHourOfFloodingAreFew) {
  std::ostringstream out;
  const Clock::time_point start = Clock::now();
  DropLines lines("run", out);
  for (int i = 0; i < 3600 * 1000; ++i) {
    lines.say("NEXTVIEW_STATUS", "no role", 1, start + std::chrono::milliseconds(i));
  }
  const std::string said = out.str();
  EXPECT_LE(std::count(said.begin(), said.end(), '\n'), 2 * (3600 + DropLines::kAtOnce));
}

}  // namespace
}  // namespace nextview

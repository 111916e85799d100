#include "runner/doctor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

namespace nextview {
namespace {

Finding finding_of(const std::vector<Finding>& findings, const std::string& what) {
  const auto found = std::ranges::find(findings, what, &Finding::what);
  if (found == findings.end()) throw std::out_of_range(what);
  return *found;
}

TEST(Doctor, LooksAtEverythingARunNeedsAndSaysWhatItFound) {
  const std::vector<Finding> findings = examine_machine(testing::TempDir());
  for (const char* what : {"programs", "recorder", "port", "network", "multicast", "socket buffers",
                           "open files", "cache"}) {
    EXPECT_FALSE(finding_of(findings, what).detail.empty()) << what;
  }
  EXPECT_TRUE(finding_of(findings, "cache").good);
  EXPECT_FALSE(finding_of(examine_machine("/proc/no such folder"), "cache").good);
}

TEST(Doctor, ShowsALineEachAndWhetherAllIsGood) {
  std::ostringstream shown;
  EXPECT_TRUE(show_findings(shown, {{"port", true, "7667"}}));
  EXPECT_FALSE(show_findings(shown, {{"port", true, "7667"}, {"cache", false, "mend it"}}));
  EXPECT_EQ(shown.str(),
            "  ok    port           7667\n"
            "  ok    port           7667\n"
            "  FAILS cache          mend it\n");
}

}  // namespace
}  // namespace nextview

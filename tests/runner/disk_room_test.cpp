#include "runner/disk_room.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <fstream>

namespace nextview {
namespace {

class DiskRoom : public testing::Test {
 protected:
  DiskRoom() {
    std::filesystem::create_directory(folder_);
    std::ofstream(folder_ / "log") << "some";
  }
  ~DiskRoom() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("nextview-room-" + std::to_string(::getpid()));
};

TEST_F(DiskRoom, IsThere) {
  EXPECT_EQ(why_no_more_fits(folder_ / "log"), std::nullopt);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_), {}), 1)
      << "what was tried is left behind";
}

TEST_F(DiskRoom, IsNotThereWithoutAFolder) {
  EXPECT_EQ(why_no_more_fits(folder_ / "nowhere" / "log"), "No such file or directory");
}

TEST_F(DiskRoom, IsNotThereAtTheLargestSizeOfAFile) {
  rlimit before{};
  ::getrlimit(RLIMIT_FSIZE, &before);
  rlimit low = before;
  low.rlim_cur = 1000;
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &low), 0);
  const auto why = why_no_more_fits(folder_ / "log");
  ::setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_EQ(why, "File too large");
}

}  // namespace
}  // namespace nextview

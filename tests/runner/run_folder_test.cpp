#include "runner/run_folder.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <optional>

#include "runner/run_setup.h"

namespace nextview {
namespace {

class FolderOfARun : public testing::Test {
 protected:
  FolderOfARun() { options_.out = (base_ / "run").string(); }
  ~FolderOfARun() override { std::filesystem::remove_all(base_); }

  template <class Call>
  static std::string why_not(const Call& call) {
    try {
      call();
    } catch (const SetupError& error) {
      return error.what();
    }
    return {};
  }
  std::string why_not_made() {
    return why_not([this] { RunFolder::make(options_, "boxes"); });
  }

  std::filesystem::path base_ =
      std::filesystem::temp_directory_path() / ("nextview-folder-" + std::to_string(::getpid()));
  RunOptions options_;
};

TEST_F(FolderOfARun, IsMadeAndKeptFromOthers) {
  std::optional<RunFolder> folder = RunFolder::make(options_, "boxes");
  EXPECT_TRUE(std::filesystem::is_directory(folder->path()));
  EXPECT_NE(why_not_made().find("another run goes on in it"), std::string::npos);
  folder.reset();
  EXPECT_EQ(why_not_made(), "");
}

TEST_F(FolderOfARun, IsNotMadeOfOneThatHoldsARun) {
  std::filesystem::create_directories(base_ / "run");
  std::ofstream(base_ / "run" / "run.lcmlog") << "log";
  EXPECT_NE(why_not_made().find("holds a run already"), std::string::npos) << why_not_made();
  EXPECT_NE(why_not_made().find("--resume"), std::string::npos) << why_not_made();
}

TEST_F(FolderOfARun, ThatCannotBeMadeIsNamed) {
  const std::string too_long(300, 'x');
  for (const std::string& folder : {std::string("/proc/nextview"), too_long, too_long + "/run"}) {
    options_.out = folder;
    EXPECT_TRUE(why_not_made().starts_with("--out: " + folder + " cannot be written to: "))
        << why_not_made();
    options_.out.clear();
    options_.runs_folder = folder;
    EXPECT_TRUE(why_not_made().starts_with("--out: " + folder)) << why_not_made();
    EXPECT_NE(why_not_made().find("name another folder"), std::string::npos) << why_not_made();
  }
}

TEST_F(FolderOfARun, IsTakenUpAgainWithItsLogOnly) {
  const auto why = [this] { return why_not([this] { RunFolder::of_earlier_run(base_ / "run"); }); };
  EXPECT_NE(why().find("no such folder"), std::string::npos) << why();
  std::filesystem::create_directories(base_ / "run");
  EXPECT_NE(why().find("there is no run.lcmlog"), std::string::npos) << why();
  std::ofstream(base_ / "run" / "run.lcmlog") << "log";
  EXPECT_EQ(why(), "");
}

TEST_F(FolderOfARun, HasANameOfItsOwnWhenNoneIsGiven) {
  options_.out.clear();
  options_.runs_folder = base_.string();
  const RunFolder one = RunFolder::make(options_, "boxes");
  const RunFolder another = RunFolder::make(options_, "boxes");
  EXPECT_NE(one.path(), another.path());
  EXPECT_TRUE(one.path().filename().string().starts_with("boxes-seed1-")) << one.path();
}

}  // namespace
}  // namespace nextview

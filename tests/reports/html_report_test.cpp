#include "reports/html_report.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "logger/recovered_run.h"
#include "reports/base64.h"

namespace nextview {
namespace {

using Json = nlohmann::ordered_json;

std::filesystem::path short_log() {
  return std::filesystem::path(NEXTVIEW_SOURCE_DIR) / "tests/logger/fixtures/surface-1.lcmlog";
}

std::string page_of(const std::vector<Json>& runs) {
  std::ostringstream out;
  write_html_report(out, runs);
  return out.str();
}

/// A folder of a run: the short log, and what else belongs beside it.
class HtmlReport : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(testing::TempDir()) /
              (std::string("nextview-report-") +
               testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
    std::filesystem::copy_file(short_log(), folder_ / "run.lcmlog");
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path folder_;
};

TEST(Base64, IsThatOfTheRfc) {
  const auto encoded = [](const std::string& text) {
    return base64({reinterpret_cast<const unsigned char*>(text.data()), text.size()});
  };
  EXPECT_EQ(encoded(""), "");
  EXPECT_EQ(encoded("f"), "Zg==");
  EXPECT_EQ(encoded("fo"), "Zm8=");
  EXPECT_EQ(encoded("foo"), "Zm9v");
  EXPECT_EQ(encoded("foobar"), "Zm9vYmFy");
  EXPECT_EQ(encoded("\xff\xfe\xfd"), "//79");
}

TEST_F(HtmlReport, HoldsWhatTheLogSays) {
  const RecoveredRun run = recover_run(folder_);
  const Json data = report_data(folder_);
  ASSERT_EQ(data["views"].size(), run.images.size());
  const commit_t& last = *run.log.record().commit(static_cast<int>(run.images.size()));
  EXPECT_EQ(data["views"].back()["map_digest"], last.map_digest);
  EXPECT_EQ(data["views"].back()["occupied_area_m2"], last.occupied_area_m2);
  EXPECT_EQ(data["stop"]["reason"], run.log.record().stop()->stop_reason);
  EXPECT_EQ(data["settings"]["map.voxel_size_m"], run.config().map.voxel_size_m);
  EXPECT_EQ(data["settings"]["base.start_m"].size(), 3U);
  EXPECT_TRUE(data["views"].back()["factors"].empty()) << "the surface strategy has none";
  EXPECT_EQ(data["log"]["messages"], run.log.counters().messages);
  EXPECT_TRUE(data["summary"].is_null());
  EXPECT_TRUE(data["views"][0]["surface_coverage"].is_null()) << "only the CAD model knows it";
  // Ten bytes a face, in base 64.
  const auto faces = static_cast<std::size_t>(run.builder.statistics().occupied_faces);
  EXPECT_EQ(data["surface"]["faces"].get<std::string>().size(), (10 * faces + 2) / 3 * 4);
  EXPECT_EQ(data["depth"]["images"].size(), run.images.size());
  EXPECT_TRUE(data["picture"].get<std::string>().starts_with("iVBORw0KGgo")) << "a PNG file";
}

TEST_F(HtmlReport, TakesWhatTheFilesOfTheRunSayBeyondIt) {
  std::ofstream(folder_ / "summary.json") << R"({"wall_s": 1.5})";
  std::ofstream(folder_ / "views.csv") << "view,surface_coverage,x\n1,0.25,9\n2,,9\n3,0.5,9\n";
  const Json data = report_data(folder_);
  EXPECT_EQ(data["summary"]["wall_s"], 1.5);
  EXPECT_EQ(data["views"][0]["surface_coverage"], 0.25);
  EXPECT_TRUE(data["views"][1]["surface_coverage"].is_null());
  EXPECT_EQ(data["views"][2]["surface_coverage"], 0.5);
  std::ofstream(folder_ / "summary.json") << "half of a";
  EXPECT_TRUE(report_data(folder_)["summary"].is_null());
}

TEST_F(HtmlReport, OfARunWithoutAWholeViewSaysWhatStoppedIt) {
  std::filesystem::resize_file(folder_ / "run.lcmlog", 1500);
  const Json data = report_data(folder_);
  EXPECT_EQ(data["stop"]["reason"], "no end");
  EXPECT_NE(data["no_map"].get<std::string>().find("no whole view is in the log"),
            std::string::npos);
  EXPECT_NE(page_of({data}).find("no whole view is in the log"), std::string::npos);
}

TEST_F(HtmlReport, AsksForNothingFromAnywhere) {
  const std::string page = page_of({report_data(folder_)});
  EXPECT_NE(page.find("default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; "
                      "img-src data:"),
            std::string::npos);
  for (const char* what :
       {"<link", " src=\"", "@import", "url(", "https://", "fetch(", "import("}) {
    EXPECT_EQ(page.find(what), std::string::npos) << what;
  }
}

TEST_F(HtmlReport, CannotBeEndedByWhatARunIsCalled) {
  Json data = report_data(folder_);
  data["name"] = "</script><b>";
  const std::string page = page_of({data});
  EXPECT_EQ(page.find("</script><b>"), std::string::npos);
  EXPECT_NE(page.find("<\\/script><b>"), std::string::npos);
  EXPECT_NE(page.find("<title>_/script__b_"), std::string::npos);
}

TEST_F(HtmlReport, OfNoLogIsRefused) {
  EXPECT_THROW(report_data(folder_ / "nowhere"), LogError);
  std::ofstream(folder_ / "run.lcmlog") << "this is no log";
  EXPECT_THROW(report_data(folder_), LogError);
}

/// What Chromium makes of the page, at a width in pixels.
std::string seen_by_chromium(const std::filesystem::path& file, int width) {
  const std::string command =
      "chromium --headless --no-sandbox --disable-dev-shm-usage --use-gl=angle "
      "--use-angle=swiftshader "
      "--enable-unsafe-swiftshader --virtual-time-budget=4000 --window-size=" +
      std::to_string(width) + ",900 --user-data-dir='" + file.parent_path().string() +
      "/profile' --dump-dom 'file://" + file.string() + "' 2>&1";
  FILE* pipe = ::popen(command.c_str(), "r");
  std::string seen;
  std::array<char, 65536> some;
  for (std::size_t n; (n = std::fread(some.data(), 1, some.size(), pipe)) > 0;) {
    seen.append(some.data(), n);
  }
  ::pclose(pipe);
  return seen;
}

int count(const std::string& text, const std::string& what) {
  int found = 0;
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += what.size()) {
    ++found;
  }
  return found;
}

TEST_F(HtmlReport, IsDrawnByChromium) {
  if (std::system("command -v chromium > /dev/null") != 0) {
    GTEST_SKIP() << "needs a browser to draw the page: apt-get install chromium";
  }
  Json data = report_data(folder_);
  data["views"].back()["factors"] = {{"structure", 0.0625}};
  const std::filesystem::path file = folder_ / "report.html";
  std::ofstream(file) << page_of({data, data});
  const std::string seen = seen_by_chromium(file, 360);
  EXPECT_NE(seen.find("data-ready=\"true\""), std::string::npos) << "the script came to its end";
  EXPECT_EQ(count(seen, "class=\"scene\""), 2) << "a picture to turn around of each run";
  EXPECT_NE(seen.find(data["views"].back()["map_digest"].get<std::string>()), std::string::npos);
  EXPECT_GE(count(seen, "<svg"), 6) << "curves";
  EXPECT_EQ(count(seen, "<tr data-view="), 2 * static_cast<int>(data["views"].size()));
  EXPECT_NE(seen.find("planner.clearance_m"), std::string::npos) << "settings";
  EXPECT_EQ(count(seen, ">f structure</th>"), 2) << "a column of each run";
  EXPECT_EQ(count(seen, ">f quality</th>"), 0) << "it does not count";
  EXPECT_EQ(count(seen, ">0.063</td>") + count(seen, ">0.062</td>"), 2);
}

}  // namespace
}  // namespace nextview

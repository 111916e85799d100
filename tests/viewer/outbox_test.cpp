#include "viewer/outbox.h"

#include <gtest/gtest.h>

#include "tests/lcmtypes/examples.h"
#include "tests/viewer/page_model.h"
#include "viewer/surface_blocks.h"

namespace nextview {
namespace {

/// A view that changes the same two blocks, to hold so many voxels each, all of quality `view`.
ViewedRun::View view_of(int view, std::uint32_t voxels) {
  ViewedRun::View made;
  made.row = {{"view", view}};
  for (std::int16_t block = 0; block < 2; ++block) {
    std::vector<std::uint8_t> surface;
    for (std::uint32_t place = 0; place < voxels; ++place) {
      append_number(surface, place);
      append_number(surface, static_cast<std::uint32_t>(view) << 24U);
    }
    made.blocks.push_back({static_cast<std::uint32_t>(block), {block, 0, 0}, surface});
  }
  made.scan = {static_cast<std::uint8_t>(view)};
  return made;
}

class OutboxTest : public testing::Test {
 protected:
  OutboxTest() {
    runs_.emplace_back("one");
    runs_.emplace_back("two");
    outbox_.emplace(runs_);
  }
  void say(const std::string& words) { outbox_->take(words, nobody); }

  std::deque<ServedRun> runs_;
  std::optional<Outbox> outbox_;
  PageModel page_;
};

TEST_F(OutboxTest, SendsNothingOfARunThatIsNotAskedForButItsName) {
  runs_[0].viewed.add_view(view_of(1, 4));
  PageModel other(1);
  EXPECT_EQ(page_.drain(*outbox_), 2) << "the facts of the two runs";
  EXPECT_EQ(page_.facts.at("name"), "one");
  EXPECT_TRUE(page_.rows.empty());
  say(R"({"show": 1, "view": null})");
  other.drain(*outbox_);
  EXPECT_EQ(other.view, 0) << "it has no view yet";
}

TEST_F(OutboxTest, GivesASlowPageTheNewestAndNeverAQueue) {
  say(R"({"show": 0, "view": null})");
  runs_[0].viewed.add_view(view_of(1, 500));
  std::vector<Outbox::Message> on_their_way;
  while (auto message = outbox_->next()) on_their_way.push_back(std::move(*message));
  EXPECT_EQ(on_their_way.size(), static_cast<std::size_t>(Outbox::kWindow));
  // The page does not read on while a thousand views come.
  for (int view = 2; view <= 1000; ++view) {
    runs_[0].viewed.add_view(view_of(view, 500));
    EXPECT_FALSE(outbox_->next());
  }
  for (const Outbox::Message& message : on_their_way) page_.take(message);
  page_.drain(*outbox_);
  EXPECT_EQ(page_.view, 1000);
  EXPECT_EQ(page_.scan_view, 1000);
  EXPECT_EQ(page_.rows.size(), 1000U);
  const auto voxels = page_.voxels();
  EXPECT_EQ(voxels.size(), 1000U);
  for (const auto& [at, voxel] : voxels) EXPECT_EQ(voxel.quality, 1000 % 256);
  // Twice the surface of a view, twice a scan, and a table of 20 bytes a view.
  EXPECT_LT(page_.bytes, 50000U);
}

TEST_F(OutboxTest, SendsOnlyWhatHasChanged) {
  runs_[0].viewed.add_view(view_of(1, 3));
  say(R"({"show": 0, "view": null})");
  page_.drain(*outbox_);
  page_.blocks.clear();
  ViewedRun::View next = view_of(2, 3);
  next.blocks.erase(next.blocks.begin());
  runs_[0].viewed.add_view(next);
  page_.drain(*outbox_);
  ASSERT_EQ(page_.blocks.size(), 1U);
  EXPECT_EQ(page_.blocks.begin()->first, (std::array<int, 3>{1, 0, 0}));
  page_.blocks.clear();
  say(R"({"show": 0, "view": 1})");
  page_.drain(*outbox_);
  EXPECT_EQ(page_.blocks.size(), 1U) << "back to what it was";
  EXPECT_EQ(page_.view, 1);
  EXPECT_EQ(page_.drain(*outbox_), 0);
}

TEST_F(OutboxTest, SendsAllToAPageThatComesBack) {
  runs_[0].viewed.add_view(view_of(1, 3));
  say(R"({"show": 0, "view": null})");
  page_.drain(*outbox_);
  Outbox after(runs_);
  PageModel again;
  after.take(R"({"show": 0, "view": null})", nobody);
  again.drain(after);
  EXPECT_EQ(again.voxels(), page_.voxels());
  EXPECT_EQ(again.rows, page_.rows);
}

TEST_F(OutboxTest, TellsOfASearchThatComesLater) {
  runs_[0].viewed.add_view(view_of(1, 3));
  say(R"({"show": 0, "view": null})");
  page_.drain(*outbox_);
  EXPECT_TRUE(page_.next.is_null());
  runs_[0].viewed.set_search(1, std::vector<std::uint8_t>(48));
  runs_[0].viewed.set_next(1, {{"view", 2}});
  page_.drain(*outbox_);
  EXPECT_EQ(page_.tried, 3U);
  EXPECT_EQ(page_.next.at("view"), 2);
}

TEST_F(OutboxTest, SetsThePaceOfARunThatCanBePaused) {
  say(R"({"pace": 0, "last_view": 4})");
  EXPECT_EQ(runs_[0].viewed.pace(), kAnyView) << "a log";
  runs_[0].viewed.set_pausable();
  say(R"({"pace": 0, "last_view": 4})");
  EXPECT_EQ(runs_[0].viewed.pace(), 4);
  page_.drain(*outbox_);
  EXPECT_EQ(page_.facts.at("paused_after"), 4);
  say(R"({"pace": 0, "last_view": null})");
  EXPECT_EQ(runs_[0].viewed.pace(), kAnyView);
  runs_[0].viewed.set_pace(2);
  runs_[0].viewed.set_end(example<stop_t>());
  page_.drain(*outbox_);
  EXPECT_TRUE(page_.facts.at("paused_after").is_null());
  EXPECT_EQ(page_.facts.at("pausable"), false);
}

TEST_F(OutboxTest, RefusesWhatMeansNothing) {
  for (const char* words :
       {"", "{}", "[]", "show", R"({"show": 2, "view": 1})", R"({"show": -1, "view": 1})",
        R"({"show": 0})", R"({"show": 0, "view": -1})", R"({"show": 0, "view": "x"})",
        R"({"pace": 7, "last_view": 1})", R"({"cad": 9})", R"({"got": "all"})"}) {
    EXPECT_THROW(say(words), std::exception) << words;
  }
}

TEST_F(OutboxTest, SaysWhyThereIsNoCadModel) {
  run_config_t config = example<run_config_t>();
  config.scene_file = "/nowhere/room.obj";
  runs_[0].viewed.set_config(config);
  say(R"({"show": 0, "view": null})");
  say(R"({"cad": 0})");
  while (!runs_[0].cad.answer().there) std::this_thread::yield();
  page_.drain(*outbox_);
  EXPECT_NE(runs_[0].cad.answer().failure.find("/nowhere/room.obj"), std::string::npos);
  EXPECT_EQ(page_.cad_vertices, 0U);
}

}  // namespace
}  // namespace nextview

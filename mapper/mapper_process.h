#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <variant>

#include "lcmtypes/bus_process.h"
#include "lcmtypes/run_course.h"
#include "mapper/block_history.h"
#include "mapper/map_builder.h"
#include "mapper/paged_map_builder.h"
#include "sensor/range_image_message.h"

namespace nextview {

/// The mapper on the bus: folds every view's range image into the map, in view order, and says with
/// a commit what the map is then. Whoever asks gets the blocks of the map that have changed since a
/// view, when there is nothing to fold.
class MapperProcess : public BusProcess {
 public:
  /// @param window voxels that are to lie open in memory (PagedMapBuilder); without it, or where it
  ///        is no smaller than the map, all of the map lies in one buffer
  MapperProcess(Bus& bus, const run_config_t& config,
                const std::optional<VoxelIndex>& window = std::nullopt);

  /// Folds the range image of the next view; else publishes the next part of the map that somebody
  /// has asked for.
  bool step() override;
  /// Asks for the view that later ones, already here, wait for; or, when it has been started again,
  /// for the next one it has not folded yet.
  void ask_again() override;
  bool waits() const override;
  bool behind() const override { return next_view_ <= reached(); }
  void on_missing(const request_t& request) override;

 private:
  RunCourse& course();
  void receive(const range_image_t& part);
  FoldCounts fold_into_map(const RangeImage& image);
  void fold(const ReceivedRangeImage& received);
  bool publish_blocks();

  Bus& bus_;
  run_config_t config_;
  std::variant<MapBuilder, PagedMapBuilder> builder_;
  RunCourse course_;
  RangeImageAssembler assembler_;
  std::map<int, ReceivedRangeImage> waiting_;  // by view; the first attempt that came whole counts
  int next_view_ = 1;
  int asked_for_view_ = 0;               // the latest view whose commit somebody waits for
  std::string history_digest_;           // of the last commit
  std::optional<BlockHistory> history_;  // of a map in one buffer
  std::int64_t utime_ = 0;               // of the last view
  std::set<int> blocks_wanted_;          // since these views
  std::deque<map_blocks_t> blocks_;      // of one answer, still to be published
};

}  // namespace nextview

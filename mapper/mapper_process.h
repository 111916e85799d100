#pragma once

#include <map>
#include <optional>
#include <string>
#include <variant>

#include "lcmtypes/bus_process.h"
#include "mapper/map_builder.h"
#include "mapper/paged_map_builder.h"
#include "sensor/range_image_message.h"

namespace nextview {

/// The mapper on the bus: folds every view's range image into the map, in view order, and says with
/// a commit what the map is then.
class MapperProcess : public BusProcess {
 public:
  /// @param window voxels that are to lie open in memory (PagedMapBuilder); without it, or where it
  ///        is no smaller than the map, all of the map lies in one buffer
  MapperProcess(Bus& bus, const run_config_t& config,
                const std::optional<VoxelIndex>& window = std::nullopt);

  /// Folds the range image of the next view.
  bool step() override;
  /// Asks for the view that later ones, already here, wait for.
  void ask_again() override;
  void on_missing(const request_t& request) override;

 private:
  void receive(const range_image_t& part);

  Bus& bus_;
  run_config_t config_;
  std::variant<MapBuilder, PagedMapBuilder> builder_;
  RangeImageAssembler assembler_;
  std::map<int, ReceivedRangeImage> waiting_;  // by view; the first attempt that came whole counts
  int next_view_ = 1;
  std::string history_digest_;  // of the last commit
};

}  // namespace nextview

#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "lcmtypes/channels.h"
#include "viewer/block_history.h"
#include "viewer/spill_file.h"

namespace nextview {

/// Of pace_t::last_view: the run goes on.
constexpr int kAnyView = std::numeric_limits<std::int32_t>::max();

/// All the page may ask about one run, view by view: written by whoever follows the run, read by
/// the connections. What a view adds in memory is its row of the table, some 1 KB, and 16 to 32
/// bytes for every block it has changed; all else lies in a file.
///
/// All functions may be called from any thread. Views are counted from 1 and come in order.
class ViewedRun {
 public:
  explicit ViewedRun(std::string name) : name_(std::move(name)), history_(file_) {}

  /// Called after every change, by the thread that makes it.
  void on_change(std::function<void()> changed) { changed_ = std::move(changed); }

  /// What the follower of the run has to say.
  struct BlockSurface {
    std::uint32_t number;
    std::array<std::int16_t, 3> coordinate;
    std::vector<std::uint8_t> surface;
  };
  struct View {
    nlohmann::json row;                ///< of the table
    std::vector<BlockSurface> blocks;  ///< that it has changed
    std::vector<std::uint8_t> scan;    ///< scan_bytes
  };
  void set_config(const run_config_t& config);
  void add_view(const View& view);
  /// What the planner has tried after a view, and where it goes to.
  void set_search(int after_view, std::vector<std::uint8_t> tried);
  void set_next(int after_view, const nlohmann::json& next);
  void set_end(const stop_t& stop);
  /// Why nothing more comes, or what is being waited for; for people.
  void set_note(const std::string& note);
  void set_pausable();

  /// How far the run may go for now; kAnyView when it is not paused.
  int pace() const;
  void set_pace(int last_view);

  /// What is to be told once, and again after it has changed: the configuration, how the run ended,
  /// its pace.
  struct Facts {
    int version = 0;
    std::string json;
  };
  Facts facts() const;
  std::optional<run_config_t> config() const;

  int views() const;
  /// The rows of the table from a view on, as a JSON array of at most so many.
  std::string rows(int first_view, int most) const;
  std::string row(int view) const { return rows(view, 1); }

  /// The blocks that changed between what somebody has and a view.
  struct Changes {
    std::vector<std::uint8_t> bytes;  ///< per block i16 x 3 coordinate, u16 voxels, the voxels
    std::uint32_t blocks = 0;
    bool all = false;  ///< nothing is left
  };
  /// @param have by block, the view since which it holds what somebody has; grows and is brought up
  ///        to date
  /// @param first block to look at; on return where to go on
  /// @param enough no further block is begun after so many bytes
  Changes changes(int view, std::vector<std::int32_t>& have, std::size_t& first,
                  std::size_t enough) const;
  /// Empty when there is none.
  std::vector<std::uint8_t> scan(int view) const;
  /// What came after a view: its version grows when something is added. Both may be empty.
  struct After {
    int version = 0;
    std::vector<std::uint8_t> tried;
    std::string next;
  };
  int after_version(int view) const;
  After after(int view) const;

  std::size_t memory_bytes() const;
  std::uint64_t file_bytes() const;

 private:
  struct AfterView {
    int version = 0;
    Spilled tried, next;
  };
  struct KeptView {
    std::string row;
    Spilled scan;
  };
  void tell() const {
    if (changed_) changed_();
  }
  AfterView& after_at(int view);

  const std::string name_;
  std::function<void()> changed_;
  mutable std::mutex mutex_;  ///< of everything below
  SpillFile file_;
  BlockHistory history_;
  std::vector<KeptView> views_;
  std::vector<AfterView> after_;  ///< by view, from 0
  std::optional<run_config_t> config_;
  std::optional<stop_t> stop_;
  std::string note_;
  bool pausable_ = false;
  int pace_ = kAnyView;
  int facts_version_ = 1;
};

}  // namespace nextview

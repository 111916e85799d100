#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "viewer/cad_model.h"
#include "viewer/viewed_run.h"

namespace nextview {

/// A run that is served.
struct ServedRun {
  explicit ServedRun(std::string name) : viewed(std::move(name)) {}
  ViewedRun viewed;
  CadModel cad;
};

/// What one page is still to be sent. It keeps no queue, only what the page has: each message is
/// made when the page has taken one, of the newest there is then. So a slow page skips what it is
/// too slow for, and costs no memory.
///
/// Messages to the page are JSON texts with a "kind", or binary, little-endian:
///   u8 kind, u8 run, u16 0, u32 view, u32 count, and then
///   1 blocks  per block i16 x 3 coordinate, u16 voxels, the voxels (surface_blocks.h): what has
///             changed on the way to `view`; a text "shown" says when it is all there
///   2 scan    scan_bytes.h
///   3 tried   per position f32 x, y, z, fitness: what the planner tried after `view`
///   4 CAD     count: vertices; see CadModel
/// The page says, in JSON texts,
///   {"got": n}                           so many messages have been taken, of all so far
///   {"show": run, "view": n or null}     this view of the run, or its newest
///   {"hide": run}
///   {"pace": run, "last_view": n or null}  see pace_t
///   {"cad": run}
class Outbox {
 public:
  struct Message {
    bool binary = false;
    std::vector<std::uint8_t> bytes;
  };
  /// So many messages may be on their way to a page.
  static constexpr std::int64_t kWindow = 4;
  /// No block is added to a message that has so many bytes.
  static constexpr std::size_t kMessageBytes = 128 * 1024;

  /// @param runs must outlive this
  explicit Outbox(std::deque<ServedRun>& runs) : runs_(runs), sides_(runs.size()) {}

  /// Takes what the page says.
  /// @throws std::runtime_error when that means nothing
  void take(const std::string& said, const std::function<void()>& changed);
  /// The next message, or nothing: the page has all, or has not yet taken what is on its way.
  std::optional<Message> next();

 private:
  /// What the page wants of a run, and has.
  struct Side {
    bool shown = false;
    std::optional<int> wanted;  ///< nothing: the newest
    int facts_version = 0;
    int rows = 0;
    std::vector<std::int32_t> blocks;  ///< see ViewedRun::changes
    int view = -1;                     ///< its blocks are being sent ...
    std::size_t next_block = 0;        ///< ... from here on
    bool complete = false;
    int scan_view = 0;
    int after_view = -1;
    int after_version = 0;
    bool tried_sent = true, next_sent = true;
    bool wants_cad = false;
  };
  Side& side_of(const nlohmann::json& number);
  std::optional<Message> next_of(std::size_t run);
  std::optional<Message> next_of_view(std::size_t run, int view);
  std::optional<Message> next_after(std::size_t run, int view);
  std::optional<Message> next_cad(std::size_t run);

  std::deque<ServedRun>& runs_;
  std::vector<Side> sides_;
  std::int64_t sent_ = 0;
  std::int64_t got_ = 0;
};

}  // namespace nextview

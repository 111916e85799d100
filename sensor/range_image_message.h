#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lcmtypes/bus.h"
#include "sensor/range_image.h"

namespace nextview {

/// How much of an image a part carries unless told otherwise, bytes of ray table and ranges.
constexpr std::size_t kPartBytes = 48 * 1024;

/// A range image as it travels: one message, or several parts when it is large.
/// @param utime simulated time of the scan, us
/// @param part_bytes of ray table and ranges a part carries at most
/// @throws std::invalid_argument unless part_bytes is 16 to kPartBytes
std::vector<range_image_t> range_image_messages(const RangeImage& image, int view, int attempt,
                                                std::int64_t utime,
                                                std::size_t part_bytes = kPartBytes);

/// A 128-bit hash, XXH3's.
using Hash128 = std::pair<std::uint64_t, std::uint64_t>;

/// A whole range image that came over the bus or out of a log.
struct ReceivedRangeImage {
  int view = 0;
  int attempt = 0;
  std::int64_t utime = 0;
  RangeImage image;
  std::vector<Hash128> part_hashes;  ///< of the parts as they travel, with run 0, in part order
};

/// The history of a run's range images up to this one; see commit_t::history_digest.
/// @param previous of the view before; empty for view 1
std::string history_digest(const std::string& previous, const ReceivedRangeImage& received);

/// Puts range images together from their parts, which may come in any order. Holds no more than it
/// has been given, whatever sizes the parts announce.
class RangeImageAssembler {
 public:
  /// Takes a part that has passed check(); a part that is there already is ignored.
  /// @return the image when this part makes it whole; it is then forgotten here
  /// @throws RejectedMessage when the part contradicts the parts before it
  std::optional<ReceivedRangeImage> add(const range_image_t& part);

  /// View and attempt of the images of which only some parts have come.
  std::vector<MessageKey> incomplete() const;
  /// Whether some parts of an image of this view are here, and some are not.
  bool has_part_of(int view) const;
  /// The parts of an image that have not come; none when none of them has.
  std::vector<PartRange> lacking(int view, int attempt) const;
  /// Forgets what has come of the images up to this view.
  void forget_until(int view);

 private:
  struct Assembly {
    std::map<int, range_image_t> parts;
    std::map<int, Hash128> hashes;
  };
  std::map<MessageKey, Assembly> assemblies_;  // by view and attempt
};

/// Asks for what is lacking of the range image of a view: for the parts, when others have come, and
/// for all of it when none has.
/// @param attempt 0: of every attempt
void request_range_image(Bus& bus, const RangeImageAssembler& assembler, int view, int attempt);

}  // namespace nextview

#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "lcmtypes/bus.h"
#include "sensor/range_image.h"

namespace nextview {

/// A range image as it travels: one message, or several parts when it is large.
/// @param utime simulated time of the scan, us
/// @param scan_wall_s how long the scan took, for people
std::vector<range_image_t> range_image_messages(const RangeImage& image, int view, int attempt,
                                                std::int64_t utime, double scan_wall_s);

/// A whole range image that came over the bus or out of a log.
struct ReceivedRangeImage {
  int view = 0;
  int attempt = 0;
  std::int64_t utime = 0;
  RangeImage image;
};

/// Puts range images together from their parts, which may come in any order.
class RangeImageAssembler {
 public:
  /// Takes a part that has passed check(); a part that is there already is ignored.
  /// @return the image when this part makes it whole; it is then forgotten here
  /// @throws RejectedMessage when the part contradicts the parts before it
  std::optional<ReceivedRangeImage> add(const range_image_t& part);

 private:
  struct Assembly {
    range_image_t description;  // the first part that came, without its ranges
    std::vector<float> range_m;
    std::vector<bool> filled;
    std::int64_t missing_pixels;
    std::set<int> parts;
  };
  std::map<MessageKey, Assembly> assemblies_;  // by view and attempt
};

}  // namespace nextview

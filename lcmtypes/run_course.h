#pragma once

#include <cstdint>
#include <map>
#include <string_view>

#include "lcmtypes/channels.h"

namespace nextview {

/// What must have been said in a run before something else can be, for whoever acts on it: there is
/// no arrival without a goal, and no range image but from where an arrival was. Who publishes on
/// the bus cannot be told, but a message that nothing led to can be refused.
///
/// Its functions throw RejectedMessage for what cannot be right, and TooEarly where it cannot be
/// told yet, as what would have led to it has not been heard.
class RunCourse {
 public:
  /// @param leads_on channel of the message that takes whoever acts on it from one view to the next
  RunCourse(const run_config_t& config, std::string_view leads_on)
      : config_(config), leads_on_(leads_on) {}

  /// As far as is known here the run has got to this view, and to none after it. Who has taken the
  /// place of another process may know of too few: it is led on when it hears of later ones.
  void at_view(int view);
  void add(const goal_t& goal);
  void add(const arrival_t& arrival);
  /// Holds a part of a range image against the configuration and its arrival.
  void check(const range_image_t& part) const;
  void forget_before(int view);

 private:
  struct Arrival {
    bool arrived;
    double believed_position_m[3];
    double believed_pan_rad;
    double believed_tilt_rad;
    std::int64_t utime;
  };
  void check_reached(int view, int attempt) const;

  run_config_t config_;
  std::string_view leads_on_;
  int at_view_ = 1;
  std::map<MessageKey, std::int64_t> goals_;  ///< their times
  std::map<MessageKey, Arrival> arrivals_;
};

/// Holds a range image against the configuration: every part says the raster of the whole.
/// @throws RejectedMessage
void check_raster(const range_image_t& part, const run_config_t& config);
/// Holds what is said of a view against the arrival it was taken after.
/// @throws RejectedMessage
void check_taken_at(const range_image_t& part, const arrival_t& arrival);
void check_taken_at(const commit_t& commit, const arrival_t& arrival);

}  // namespace nextview

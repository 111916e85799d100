#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "lcmtypes/decode.h"
#include "logger/run_log.h"

namespace nextview {

/// What a recorder hears, in order.
using Recording = std::vector<std::pair<std::string, std::vector<std::uint8_t>>>;

/// A run of 4 views with a small raster in the room "boxes", carried out in this process: planner,
/// mapper and simulated sensor, and a base that refuses the first goal of view 3.
Recording record_run();

/// The recording as it would be with a driver in the place of a simulator, who says nothing of how
/// he is: "base_sim" or "sensor_sim".
Recording with_driver_for(const std::string& role, const Recording& recording);

/// The log of a recording, read to its end.
RunLog log_of(const Recording& recording);

/// The recording with the seal that its run puts behind it.
Recording sealed(Recording recording);

/// The recording with every message of a type as `change` leaves it.
template <class Message>
Recording changed(Recording recording, const std::function<void(Message&)>& change) {
  for (auto& [channel, bytes] : recording) {
    if (channel != Channel<Message>::name) continue;
    Message message = decode_checked<Message>(bytes).message.value();
    change(message);
    bytes = encode(message);
  }
  return recording;
}

/// The recording without the messages of a type that `leave_out` names.
template <class Message>
Recording without(Recording recording, const std::function<bool(const Message&)>& leave_out) {
  std::erase_if(recording, [&](const auto& logged) {
    return logged.first == Channel<Message>::name &&
           leave_out(decode_checked<Message>(logged.second).message.value());
  });
  return recording;
}

}  // namespace nextview

#pragma once

#include <functional>
#include <string>

#include "lcmtypes/bus_process.h"

namespace nextview {

/// Says by a status_t how this process is.
/// @param failure why it has failed; empty when it has not
void publish_status(Bus& bus, const std::string& failure);

/// The life of a process on the bus: asks for the run's configuration until it comes, makes the
/// process, says that it is there, and does its work, asking again for what does not come.
/// @param ended whether a signal has asked for the end; looked at after every message and wait
/// @param catch_up the view the run has got to already; 0 in a run that begins
void serve(Bus& bus, const MakeBusProcess& make, const std::function<bool()>& ended,
           int catch_up = 0);

}  // namespace nextview

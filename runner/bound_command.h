#pragma once

#include <string>

namespace nextview {

/// The command that works out the bounds a run is held against: nextview_bound in the folder of
/// nextview_run, with what has been typed for the run, but for what it leaves and shows (--out,
/// --view).
std::string bound_command_for(int argc, char** argv);

}  // namespace nextview

#pragma once

#include <functional>

#include "lcmtypes/channels.h"
#include "scene/scene.h"

namespace nextview {

/// The scene a run is simulated in: run_config_t's scene_file, read with its unit and up axis.
/// @param interrupted  as in LoadLimits
/// @throws SceneError when it cannot be loaded, or is not the one whose digest the run has
Scene load_scene(const run_config_t& config, const std::function<bool()>& interrupted = {});

}  // namespace nextview

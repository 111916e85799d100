#pragma once

#include <numbers>

#include "scene/mesh_file.h"
#include "tests/lcmtypes/examples.h"

namespace nextview {

/// The configuration of run 7, in the room "boxes"; how many views it has is the test's to say.
inline run_config_t boxes_run_config() {
  run_config_t config = example<run_config_t>();
  config.scene_file = NEXTVIEW_SOURCE_DIR "/scenes/boxes/boxes.obj";
  const TriangleMesh mesh = load_mesh(config.scene_file);
  config.scene_digest = mesh_digest(mesh);
  config.base.start_m[0] = 0.7;
  config.base.start_m[1] = 1.0;
  config.base.start_m[2] = 1.2;
  config.base.start_pan_rad = -std::numbers::pi / 2.0;
  for (int axis = 0; axis < 3; ++axis) {
    config.base.workspace_min_m[axis] = mesh.bounds_m().min()[axis];
    config.base.workspace_max_m[axis] = mesh.bounds_m().max()[axis];
    config.map.window_min[axis] = -1;
    config.map.window_size[axis] = 64;
  }
  return config;
}

}  // namespace nextview

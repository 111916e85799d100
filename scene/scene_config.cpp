#include "scene/scene_config.h"

#include "scene/mesh_file.h"
#include "scene/triangle_mesh.h"

namespace nextview {

Scene load_scene(const run_config_t& config, const std::function<bool()>& interrupted) {
  if (config.has_scene == 0) throw SceneError("the run has no scene to simulate");
  SceneOptions options;
  if (config.scene.unit_m > 0.0) options.unit_m = config.scene.unit_m;
  if (!config.scene_up.empty()) options.up = parse_up_axis(config.scene_up);
  LoadLimits limits = load_limits();
  limits.interrupted = interrupted;
  TriangleMesh mesh = load_mesh(config.scene_file, options, limits);
  const std::string digest = mesh_digest(mesh);
  if (mesh.origin_in_file_m != Eigen::Vector3d(config.scene.origin_in_file_m)) {
    throw SceneError(config.scene_file +
                     ": lies elsewhere than where the run was set up for it; has "
                     "the file changed?");
  }
  if (digest != config.scene_digest) {
    throw SceneError(config.scene_file + ": its triangles have digest " + digest +
                     ", but the run was set up for " + config.scene_digest +
                     "; has the file changed?");
  }
  return Scene(std::move(mesh));
}

}  // namespace nextview

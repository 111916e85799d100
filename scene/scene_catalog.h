#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scene/mesh_file.h"

namespace nextview {

/// Which CAD file to load and how, and what its scene.json says about it.
struct SceneDescription {
  std::string name;            ///< of the scene.json, else the file's name without extension
  std::filesystem::path file;  ///< the CAD file
  SceneOptions options;        ///< for load_mesh
  std::optional<Eigen::Vector3d>
      start_m;  ///< where a run starts: the frame of the file, metres and z up
  std::optional<double> start_pan_rad;
  std::optional<double> surface_area_m2;  ///< of all triangles, as documented
  std::optional<std::int64_t> triangles;  ///< in the file, as documented
};

/// Names of the scenes in a folder (its sub-folders with a scene.json), in alphabetical order.
std::vector<std::string> known_scenes(const std::filesystem::path& scenes_folder);

/// What a user means by a scene: the name of a folder of scenes_folder, or the path of a CAD file
/// (or of a folder with a scene.json). A scene.json beside a CAD file counts when it names that
/// file. What `given` sets wins over what a scene.json says.
/// @throws SceneError when nothing of that name exists (the message lists the known names) or a
/// scene.json is malformed
SceneDescription find_scene(const std::string& argument, const std::filesystem::path& scenes_folder,
                            const SceneOptions& given = {});

}  // namespace nextview

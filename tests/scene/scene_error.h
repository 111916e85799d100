#pragma once

#include <functional>
#include <string>

#include "scene/mesh_file.h"

namespace nextview {

/// What the SceneError says that an action throws.
inline std::string message_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const SceneError& error) {
    return error.what();
  }
  return "no SceneError";
}

}  // namespace nextview

#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>

namespace nextview {

/// The bytes of a CAD file with `shift` taken from every vertex, in double and before anybody makes
/// floats of them. Everything else stays as it is.
/// @return nothing when the bytes are not understood, or hold floats already

/// Wavefront OBJ.
std::optional<std::string> shifted_obj(std::string_view bytes, const Eigen::Vector3d& shift);
/// PLY as text, or binary little endian with doubles; its vertices come first, of numbers only.
std::optional<std::string> shifted_ply(std::string_view bytes, const Eigen::Vector3d& shift);

}  // namespace nextview

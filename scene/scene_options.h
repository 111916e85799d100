#pragma once

#include <optional>
#include <stdexcept>
#include <string_view>

namespace nextview {

/// A scene that cannot be used; the message names the file and says what to do.
class SceneError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The axis of a CAD file that points up in the world.
enum class UpAxis { X, Y, Z };

/// "x", "y" or "z", either case.
/// @throws std::invalid_argument for anything else
UpAxis parse_up_axis(std::string_view text);

/// Its name: "x", "y" or "z".
std::string_view name_of(UpAxis axis);

/// "m", "cm", "mm", "in", "ft" or a positive number of metres such as "0.0042".
/// @throws std::invalid_argument for anything else
double parse_unit_m(std::string_view text);

/// How to read a CAD file's coordinates. What is left unset is what the file itself says: COLLADA
/// by its <up_axis> and <unit>, glTF by its specification (y up, metres). Every other format is
/// read as z up and metres; most say nothing, and what FBX may say is not asked.
struct SceneOptions {
  std::optional<double> unit_m = {};  ///< length of the file's unit of length
  std::optional<UpAxis> up = {};      ///< the file's axis that becomes the world's z
};

}  // namespace nextview

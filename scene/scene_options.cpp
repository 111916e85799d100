#include "scene/scene_options.h"

#include <charconv>
#include <string>

#include "lcmtypes/parameter_bounds.h"

namespace nextview {

std::string_view name_of(UpAxis axis) {
  switch (axis) {
    case UpAxis::X:
      return "x";
    case UpAxis::Y:
      return "y";
    case UpAxis::Z:
      return "z";
  }
  throw std::invalid_argument("not an axis");
}

UpAxis parse_up_axis(std::string_view text) {
  if (text == "x" || text == "X") return UpAxis::X;
  if (text == "y" || text == "Y") return UpAxis::Y;
  if (text == "z" || text == "Z") return UpAxis::Z;
  throw std::invalid_argument("up axis '" + std::string(text) + "': must be x, y or z");
}

double parse_unit_m(std::string_view text) {
  if (text == "m") return 1.0;
  if (text == "cm") return 0.01;
  if (text == "mm") return 0.001;
  if (text == "in") return 0.0254;
  if (text == "ft") return 0.3048;
  double metres = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), metres);
  if (error == std::errc() && end == text.data() + text.size() && bounds::kUnit.contain(metres)) {
    return metres;
  }
  throw std::invalid_argument("unit '" + std::string(text) +
                              "': must be m, cm, mm, in, ft or metres, a number " +
                              bounds::kUnit.range());
}

}  // namespace nextview

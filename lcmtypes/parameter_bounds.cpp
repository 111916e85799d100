#include "lcmtypes/parameter_bounds.h"

#include <fmt/format.h>

namespace nextview {

std::string Bounds::range() const {
  if (most < bounds::kUnlimited) return fmt::format("from {:g} to {:g}", least, most);
  return least > -bounds::kUnlimited ? fmt::format("of {:g} or more", least) : "and finite";
}

std::string Bounds::refusal(double value) const {
  if (contain(value)) return {};
  return fmt::format("{} = {:g} is not a number {}", name, value, range());
}

}  // namespace nextview

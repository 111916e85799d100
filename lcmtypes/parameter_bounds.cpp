#include "lcmtypes/parameter_bounds.h"

#include <fmt/format.h>

namespace nextview {

std::string Bounds::range() const {
  if (most < bounds::kUnlimited) return fmt::format("from {:.6g} to {:.6g}", least, most);
  return least > -bounds::kUnlimited ? fmt::format("of {:.6g} or more", least) : "and finite";
}

std::string Bounds::refusal(double value) const {
  if (contain(value)) return {};
  return fmt::format("{} = {:g} is not a number {}", name, value, range());
}

std::string refusal_unless_below(std::string_view low_name, double low, std::string_view high_name,
                                 double high) {
  if (low < high) return {};
  return fmt::format("{} = {:g} is not below {} = {:g}", low_name, low, high_name, high);
}

void require_below(std::string_view low_name, double low, std::string_view high_name, double high) {
  const std::string refusal = refusal_unless_below(low_name, low, high_name, high);
  if (!refusal.empty()) throw std::invalid_argument(refusal);
}

}  // namespace nextview

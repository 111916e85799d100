#pragma once

#include <fmt/format.h>

#include <cmath>
#include <span>
#include <string>
#include <string_view>

#include "lcmtypes/parameter_bounds.h"

namespace nextview {

/// Collects what is wrong with a message; the first reason found stands.
class Checks {
 public:
  void require(bool holds, std::string_view reason) {
    if (!holds && reason_.empty()) reason_ = reason;
  }
  void finite(std::string_view name, double value) {
    if (!std::isfinite(value)) fail(name, value, "not finite");
  }
  void finite(std::string_view name, std::span<const double> values) {
    for (const double value : values) finite(name, value);
  }
  /// Bounds included; NaN is outside.
  void within(std::string_view name, double value, double least, double most) {
    if (!(value >= least && value <= most)) fail(name, value, "out of range");
  }
  void within(const Bounds& bounds, double value) {
    require(bounds.contain(value), bounds.refusal(value));
  }
  void within(const Bounds& bounds, std::span<const double> values) {
    for (const double value : values) within(bounds, value);
  }
  void below(std::string_view low_name, double low, std::string_view high_name, double high) {
    require(low < high, refusal_unless_below(low_name, low, high_name, high));
  }
  void not_negative(std::string_view name, double value) {
    if (!(value >= 0.0 && std::isfinite(value))) fail(name, value, "negative or not finite");
  }
  void positive(std::string_view name, double value) {
    if (!(value > 0.0 && std::isfinite(value))) fail(name, value, "not positive");
  }
  void digest(std::string_view name, std::string_view text) {
    const bool right =
        text.size() == 32 && text.find_first_not_of("0123456789abcdef") == std::string_view::npos;
    require(right, fmt::format("{} is not 32 hexadecimal digits", name));
  }
  std::string reason() const { return reason_; }

 private:
  void fail(std::string_view name, double value, std::string_view fault) {
    require(false, fmt::format("{} = {:g}: {}", name, value, fault));
  }
  std::string reason_;
};

}  // namespace nextview

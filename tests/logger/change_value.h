#pragma once

#include <cmath>
#include <iterator>
#include <limits>
#include <string>
#include <type_traits>

namespace nextview {

/// By how much a number is changed: its last bit, or enough to matter to what depends on it.
enum class Change { LastBit, Much };

/// Makes a value another one, an array by its last element; false for an empty one. Integers get
/// smaller where they can, so that one that is an array's length stays within the array.
template <class Value>
bool change(Value& value, Change by) {
  if constexpr (std::is_floating_point_v<Value>) {
    if (!std::isfinite(value)) {
      value = 1;
    } else if (by == Change::Much) {
      value = value * Value(1.01) + Value(0.01);
    } else {
      value = std::nextafter(value, value > 0 ? Value(0) : std::numeric_limits<Value>::max());
    }
    return true;
  } else if constexpr (std::is_integral_v<Value>) {
    value = static_cast<Value>(value > 0 ? value - 1 : value + 1);
    return true;
  } else if constexpr (std::is_same_v<Value, std::string>) {
    if (value.empty()) {
      value = "x";
    } else {
      value.back() = value.back() == '1' ? '2' : '1';
    }
    return true;
  } else {
    return std::size(value) > 0 && change(value[std::size(value) - 1], by);
  }
}

}  // namespace nextview

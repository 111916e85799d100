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

/// Makes a value one of some others that its field may well have; false when there are no more.
template <class Value>
bool set_other(Value& value, int which) {
  if constexpr (std::is_floating_point_v<Value>) {
    const Value others[] = {std::nextafter(value, Value(1e9)), Value(1), Value(0), 2 * value};
    if (which >= std::ssize(others)) return false;
    value = others[which];
    return true;
  } else if constexpr (std::is_integral_v<Value>) {
    const int others[] = {static_cast<int>(value) + 1, static_cast<int>(value) - 1, 1, 2, 3, 80};
    if (which >= std::ssize(others)) return false;
    value = static_cast<Value>(others[which]);
    return true;
  } else if constexpr (std::is_same_v<Value, std::string>) {
    constexpr const char* kOthers[] = {"x", "y", "z"};
    if (which >= std::ssize(kOthers)) return false;
    value = kOthers[which];
    return true;
  } else {
    constexpr int kEach = 6;
    const int element = which / kEach;
    if (element >= std::ssize(value)) return false;
    set_other(value[static_cast<std::size_t>(element)], which % kEach);
    return true;
  }
}

}  // namespace nextview

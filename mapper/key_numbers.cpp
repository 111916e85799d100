#include "mapper/key_numbers.h"

#include <algorithm>
#include <bit>

namespace nextview {

void KeyNumbers::clear(std::size_t expected) {
  keys_.clear();
  resize_table(std::max(table_.size(), 2 * expected));
}

void KeyNumbers::grow() {
  resize_table(2 * table_.size());
  for (std::size_t number = 0; number < keys_.size(); ++number) {
    table_[place_of(keys_[number])] = static_cast<std::uint32_t>(number);
  }
}

void KeyNumbers::resize_table(std::size_t places) {
  table_.assign(std::bit_ceil(std::max<std::size_t>(1024, places)), kNone);
  shift_ = 64 - std::countr_zero(table_.size());
}

}  // namespace nextview

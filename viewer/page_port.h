#pragma once

#include <cstdint>

namespace nextview {

/// Of the page on 127.0.0.1, where a browser finds it again after a restart, if nobody else has it.
constexpr std::uint16_t kPagePort = 7660;

}  // namespace nextview

#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "reports/recovered_picture.h"

namespace nextview {

/// The picture with its legend below, if it has one, as the bytes of a PNG file.
/// @throws std::runtime_error when it cannot be encoded
std::vector<std::uint8_t> png_bytes(const Picture& picture, std::span<const LegendLine> legend);

/// The same in a file.
/// @throws std::runtime_error naming the file when it cannot be written
void write_png(const Picture& picture, std::span<const LegendLine> legend,
               const std::filesystem::path& file);

}  // namespace nextview

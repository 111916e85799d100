#include "reports/picture_file.h"

#include <cairo.h>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <stdexcept>

namespace nextview {
namespace {

constexpr double kMargin = 10.0;  // pixels

using Surface = std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)>;

void copy_picture(const Picture& picture, cairo_surface_t* surface) {
  cairo_surface_flush(surface);
  unsigned char* const bytes = cairo_image_surface_get_data(surface);
  const int stride = cairo_image_surface_get_stride(surface);
  for (int y = 0; bytes != nullptr && y < picture.height; ++y) {
    auto* const row = reinterpret_cast<std::uint32_t*>(bytes + std::ptrdiff_t{y} * stride);
    for (int x = 0; x < picture.width; ++x) {
      const auto at = 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width) +
                           static_cast<std::size_t>(x));
      row[x] = std::uint32_t{picture.rgb[at]} << 16 | std::uint32_t{picture.rgb[at + 1]} << 8 |
               std::uint32_t{picture.rgb[at + 2]};
    }
  }
  cairo_surface_mark_dirty(surface);
}

void draw_line(cairo_t* draw, const LegendLine& line, double top, double text_size) {
  const double swatch = 3.0 * text_size;
  const auto& [from, to, text] = line;
  const std::unique_ptr<cairo_pattern_t, decltype(&cairo_pattern_destroy)> colours(
      cairo_pattern_create_linear(kMargin, 0.0, kMargin + swatch, 0.0), &cairo_pattern_destroy);
  cairo_pattern_add_color_stop_rgb(colours.get(), 0.0, from[0], from[1], from[2]);
  cairo_pattern_add_color_stop_rgb(colours.get(), 1.0, to[0], to[1], to[2]);
  cairo_rectangle(draw, kMargin, top, swatch, text_size);
  cairo_set_source(draw, colours.get());
  cairo_fill_preserve(draw);
  cairo_set_source_rgb(draw, 0.5, 0.5, 0.5);
  cairo_set_line_width(draw, 1.0);
  cairo_stroke(draw);
  cairo_set_source_rgb(draw, 0.1, 0.1, 0.1);
  cairo_move_to(draw, 2.0 * kMargin + swatch, top + 0.85 * text_size);
  cairo_show_text(draw, text.c_str());
}

Surface drawn(const Picture& picture, std::span<const LegendLine> legend) {
  const double text_size = std::clamp(picture.width / 95.0, 6.0, 20.0);
  const double line_height = 1.5 * text_size;
  const auto lines = static_cast<double>(legend.size());
  const int legend_height =
      legend.empty() ? 0 : static_cast<int>(2.0 * kMargin + line_height * lines);
  Surface surface(
      cairo_image_surface_create(CAIRO_FORMAT_RGB24, picture.width, picture.height + legend_height),
      &cairo_surface_destroy);
  const std::unique_ptr<cairo_t, decltype(&cairo_destroy)> context(cairo_create(surface.get()),
                                                                   &cairo_destroy);
  cairo_t* const draw = context.get();
  cairo_set_source_rgb(draw, 1.0, 1.0, 1.0);
  cairo_paint(draw);
  copy_picture(picture, surface.get());
  cairo_select_font_face(draw, "sans-serif", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(draw, text_size);
  double top = picture.height + kMargin;
  for (const LegendLine& line : legend) {
    draw_line(draw, line, top, text_size);
    top += line_height;
  }
  return surface;
}

cairo_status_t append(void* bytes, const unsigned char* data, unsigned int size) {
  auto* const all = static_cast<std::vector<std::uint8_t>*>(bytes);
  all->insert(all->end(), data, data + size);
  return CAIRO_STATUS_SUCCESS;
}

}  // namespace

std::vector<std::uint8_t> png_bytes(const Picture& picture, std::span<const LegendLine> legend) {
  std::vector<std::uint8_t> bytes;
  const cairo_status_t status =
      cairo_surface_write_to_png_stream(drawn(picture, legend).get(), &append, &bytes);
  if (status != CAIRO_STATUS_SUCCESS) {
    throw std::runtime_error(std::string("the picture cannot be encoded: ") +
                             cairo_status_to_string(status));
  }
  return bytes;
}

void write_png(const Picture& picture, std::span<const LegendLine> legend,
               const std::filesystem::path& file) {
  const cairo_status_t status =
      cairo_surface_write_to_png(drawn(picture, legend).get(), file.c_str());
  if (status != CAIRO_STATUS_SUCCESS) {
    throw std::runtime_error(file.string() +
                             ": the picture cannot be written: " + cairo_status_to_string(status));
  }
}

}  // namespace nextview

#pragma once

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace nextview {

/// Writes the paper's room "boxes" as it would be on a map of the country, its origin at (east_m,
/// north_m).
inline void write_far_boxes(const std::filesystem::path& file, double east_m, double north_m) {
  std::ifstream boxes(std::filesystem::path(NEXTVIEW_SOURCE_DIR) / "scenes" / "boxes" /
                      "boxes.obj");
  std::ofstream far_off(file);
  far_off.precision(17);
  for (std::string line; std::getline(boxes, line);) {
    std::istringstream words(line);
    std::string word;
    double x = 0.0;
    double y = 0.0;
    std::string z;
    if (words >> word && word == "v" && words >> x >> y >> z) {
      far_off << "v " << x + east_m << ' ' << y + north_m << ' ' << z << '\n';
    } else {
      far_off << line << '\n';
    }
  }
}

}  // namespace nextview

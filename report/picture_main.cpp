#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <vector>

#include "lcmtypes/program_version.h"
#include "logger/recovered_run.h"
#include "report/recovered_picture.h"

namespace {

void draw_run(const std::filesystem::path& folder, const std::filesystem::path& file, int views,
              const nextview::PictureView& view) {
  const nextview::RecoveredRun run = nextview::recover_run(folder, std::nullopt, views);
  std::vector<nextview::SensorPose> poses;
  for (const auto* received : run.images) poses.push_back(received->image.pose);
  write_png(recovered_picture(run.builder.map(), poses, view), file);
  std::cout << file.string() << ": " << poses.size() << " views" << std::endl;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{
      "Draws what a run has recovered (paper figure 9): Occupied voxels coloured by height, the\n"
      "sensor's path dashed, its poses with their directions. From the log alone.\n"};
  std::string folder;
  std::string file;
  int views = std::numeric_limits<int>::max();
  nextview::PictureView view;
  app.add_option("DIR", folder, "Folder of a run")->required()->check(CLI::ExistingDirectory);
  app.add_option("FILE", file, "PNG file to write; default DIR/recovered.png");
  app.add_option("--views", views, "Draw the map after this many views; default all")
      ->check(CLI::PositiveNumber);
  app.add_option("--azimuth", view.azimuth_deg, "Where to look from, degrees: 0 = +x, 90 = +y")
      ->capture_default_str();
  app.add_option("--elevation", view.elevation_deg, "How steeply, degrees")
      ->check(CLI::Range(1.0, 89.0))
      ->capture_default_str();
  app.add_option("--width", view.width, "Pixels")
      ->check(CLI::Range(16, 8192))
      ->capture_default_str();
  app.add_option("--height", view.height, "Pixels")
      ->check(CLI::Range(16, 8192))
      ->capture_default_str();
  app.set_version_flag("--version", "nextview_picture " + std::string(nextview::program_version()));
  CLI11_PARSE(app, argc, argv);
  try {
    draw_run(folder,
             file.empty() ? std::filesystem::path(folder) / "recovered.png"
                          : std::filesystem::path(file),
             views, view);
  } catch (const std::exception& error) {
    std::cerr << "nextview_picture: " << error.what() << std::endl;
    return 1;
  }
  return 0;
}

#include <CLI/CLI.hpp>
#include <array>
#include <optional>

#include "mapper/mapper_process.h"

int main(int argc, char** argv) {
  std::optional<std::array<int, 3>> window;
  return nextview::run_bus_process(
      argc, argv, "mapper",
      "The mapper of a nextview run. It folds every view's range image into a voxel map, in view\n"
      "order, and publishes what the map is then: counts, areas, quality and a digest of all of "
      "it\n"
      "(NEXTVIEW_COMMIT); to whoever asks, the blocks that have changed (NEXTVIEW_MAP_BLOCKS). It\n"
      "knows of the scene only what the range images say.",
      [&window](nextview::Bus& bus, const nextview::run_config_t& config) {
        std::optional<nextview::VoxelIndex> size;
        if (window) size = nextview::VoxelIndex(window->data());
        return std::make_unique<nextview::MapperProcess>(bus, config, size);
      },
      [&window](CLI::App& app) {
        app.add_option("--window", window,
                       "Voxels along x, y and z that lie open in memory about the sensor; the rest "
                       "of what was seen is kept aside, packed. Default: the whole map lies in one "
                       "buffer. The map is the same")
            ->check(CLI::Range(1, 16384));
      });
}

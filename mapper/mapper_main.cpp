#include "mapper/mapper_process.h"

int main(int argc, char** argv) {
  return nextview::run_bus_process(
      argc, argv, "mapper",
      "The mapper of a nextview run. It folds every view's range image into a voxel map, in view\n"
      "order, and publishes what the map is then: counts, areas, quality and a digest of all of "
      "it\n"
      "(NEXTVIEW_COMMIT); to whoever asks, the blocks that have changed (NEXTVIEW_MAP_BLOCKS). It\n"
      "knows of the scene only what the range images say.",
      [](nextview::Bus& bus, const nextview::run_config_t& config) {
        return std::make_unique<nextview::MapperProcess>(bus, config);
      });
}

// In the place of octree_file.cpp where OctoMap is not installed.
#include <stdexcept>

#include "exporter/octree_file.h"

namespace nextview {

void write_octree(const VoxelMap&, std::span<const VoxelIndex>, const std::filesystem::path& file) {
  throw std::runtime_error(file.string() +
                           ": this program was built without OctoMap; install liboctomap-dev, "
                           "remove build/release and build again");
}

}  // namespace nextview

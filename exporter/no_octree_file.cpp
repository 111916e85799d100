// In the place of octree_file.cpp where OctoMap is not installed.
#include <stdexcept>

#include "exporter/octree_file.h"

namespace nextview {

void write_octree(const VoxelMap&, std::span<const VoxelIndex>, const std::filesystem::path& file) {
  throw std::runtime_error(file.string() +
                           ": this program was built without OctoMap; in the folder of nextview "
                           "type: sudo apt-get install liboctomap-dev && cmake build/release && "
                           "ninja -C build/release programs");
}

}  // namespace nextview

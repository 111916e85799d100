// A CAD file, of a format that the first byte says, read as a run does: by a process of its own,
// which may crash, hang and fill its memory. NEXTVIEW_CAD_SECONDS=1 makes those that hang cost
// less.
#include <array>
#include <map>
#include <memory>

#include "scene/mesh_file.h"
#include "tests/fuzz/fuzz_input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace nextview;
  static constexpr std::array kFormats = {"obj", "ply", "stl", "off", "gltf",
                                          "dae", "3ds", "x",   "x3d"};
  static std::map<std::string, std::unique_ptr<FuzzFile>> files;
  if (size == 0) return 0;
  const std::string format = kFormats.at(bytes[0] % kFormats.size());
  auto& file = files[format];
  if (!file) file = std::make_unique<FuzzFile>("model." + format);
  try {
    (void)load_mesh(file->hold(FuzzInput(bytes + 1, size - 1)), {});
  } catch (const SceneError&) {
    // Said to the user.
  }
  return 0;
}

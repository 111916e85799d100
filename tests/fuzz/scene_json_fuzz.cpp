// The scene.json of a folder.
#include "scene/scene_catalog.h"
#include "tests/fuzz/fuzz_input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace nextview;
  static FuzzFile file("scene.json");
  file.hold(FuzzInput(bytes, size));
  try {
    (void)find_scene(file.folder().string(), file.folder() / "no_catalogue");
  } catch (const SceneError&) {
    // Said to the user.
  }
  return 0;
}

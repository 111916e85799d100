// What a process that was to read a CAD file, and has gone astray, hands back.
#include <cmath>
#include <cstdio>
#include <memory>

#include "scene/cad_answer.h"
#include "tests/fuzz/fuzz_input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace nextview;
  static FuzzFile file("answer");
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> answer_file(
      std::fopen(file.hold(FuzzInput(bytes, size)).c_str(), "rb"), std::fclose);
  const auto answer = take_answer(answer_file.get());
  if (!answer || !answer->mesh) return 0;
  for (const auto& triangle : answer->mesh->triangles) {
    for (const auto corner : triangle) {
      demand(corner < answer->mesh->vertices_m.size(), "every corner is there");
      demand(answer->mesh->vertices_m[corner].allFinite(), "every corner is somewhere");
    }
  }
  return 0;
}

#include "scene/mesh_file.h"

#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <string>
#include <utility>

#include "scene/cad_reader.h"

namespace nextview {
namespace {

constexpr const char* kSecondsVariable = "NEXTVIEW_CAD_SECONDS";
constexpr const char* kMemoryVariable = "NEXTVIEW_CAD_MEMORY_MB";

int limit_from(const char* variable, int otherwise) {
  const char* text = std::getenv(variable);
  if (text == nullptr || *text == '\0') return otherwise;
  int limit = 0;
  const char* const last = text + std::strlen(text);
  const auto [end, error] = std::from_chars(text, last, limit);
  if (error == std::errc() && end == last && limit > 0) return limit;
  throw SceneError(std::string(variable) + " is '" + text + "': must be a positive whole number");
}

}  // namespace

LoadLimits load_limits() {
  LoadLimits limits;
  limits.seconds = limit_from(kSecondsVariable, limits.seconds);
  limits.memory_mb = limit_from(kMemoryVariable, limits.memory_mb);
  return limits;
}

TriangleMesh load_mesh(const std::filesystem::path& file, const SceneOptions& options,
                       const LoadLimits& limits) {
  constexpr int kLook_ms = 20;
  const auto fail = [&file](const std::string& what) {
    throw SceneError(file.string() + ": " + what);
  };
  const auto too_much = [&fail](const std::string& what, const char* variable) {
    fail("reading it " + what +
         ", so the file is broken or very large: export it again, reduce it, or set " + variable +
         " to a higher limit");
  };
  if (options.unit_m && !(std::isfinite(*options.unit_m) && *options.unit_m > 0.0)) {
    fail("the unit must be a positive length");
  }
  CadReader reader(file, options);
  for (std::int64_t waited_ms = 0; !reader.wait_for_end(kLook_ms); waited_ms += kLook_ms) {
    if (limits.interrupted && limits.interrupted()) fail("reading it was interrupted by a signal");
    if (reader.resident_bytes() > std::int64_t{limits.memory_mb} * 1'000'000) {
      too_much("needed more than " + std::to_string(limits.memory_mb) + " MB", kMemoryVariable);
    }
    if (waited_ms >= std::int64_t{limits.seconds} * 1000) {
      too_much("took longer than " + std::to_string(limits.seconds) + " s", kSecondsVariable);
    }
  }
  std::optional<CadAnswer> answer = reader.answer();
  if (!answer) {
    fail("reading it crashed: the reader " + reader.how_it_ended() +
         "; the file is broken, or assimp cannot cope with it: export it again, or convert it to "
         "another format");
  }
  if (!answer->mesh) throw SceneError(answer->why_not);
  return *std::move(answer->mesh);
}

}  // namespace nextview

#include "viewer/cad_model.h"

#include <utility>

#include "scene/scene_config.h"
#include "viewer/surface_blocks.h"

namespace nextview {
namespace {

CadModel::Mesh bytes_of(const TriangleMesh& mesh) {
  CadModel::Mesh made;
  made.vertices = static_cast<std::uint32_t>(mesh.vertices_m.size());
  append_number(made.bytes, static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const Eigen::Vector3f& vertex : mesh.vertices_m) {
    for (const float value : vertex) append_number(made.bytes, value);
  }
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t corner : triangle) append_number(made.bytes, corner);
  }
  return made;
}

}  // namespace

void CadModel::load(const run_config_t& config, std::function<void()> done) {
  if (loader_.joinable()) return;
  loader_ = std::jthread([this, config, done = std::move(done)](const std::stop_token& stop) {
    try {
      const Scene scene = load_scene(config, [&stop] { return stop.stop_requested(); });
      set({true, std::make_shared<const Mesh>(bytes_of(scene.mesh())), {}});
    } catch (const std::exception& error) {
      set({true, nullptr, error.what()});
    }
    if (!stop.stop_requested()) done();
  });
}

void CadModel::set(Answer answer) {
  const std::lock_guard lock(mutex_);
  answer_ = std::move(answer);
}

CadModel::Answer CadModel::answer() const {
  const std::lock_guard lock(mutex_);
  return answer_;
}

}  // namespace nextview

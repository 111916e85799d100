// How long it takes to find out what of a scene can be seen at all, the first time.
//
// nextview_bench_coverage SCENE [SHARE]: boxes, columns, hospital, or a model in ../shared/scenes;
// of its samples a share, 1 by default.

#include <fmt/format.h>
#include <sys/resource.h>

#include <chrono>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <iostream>

#include "base_sim/base.h"
#include "bench/hospital.h"
#include "bench/recovered_room.h"
#include "lcmtypes/standard_output.h"
#include "lcmtypes/tell_version.h"
#include "scene/mesh_file.h"
#include "scoring/visible_surface.h"

namespace nextview {
namespace {

double cpu_s() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

std::uint64_t checksum(const VisibleSurface& surface) {
  std::uint64_t sum = 1469598103934665603ULL;
  for (const Eigen::Vector3f& point_m : surface.points_m) {
    for (const float value : point_m) {
      std::uint32_t bits = 0;
      static_assert(sizeof bits == sizeof value);
      std::memcpy(&bits, &value, sizeof bits);
      sum = (sum ^ bits) * 1099511628211ULL;
    }
  }
  return sum;
}

BenchScene scene_of(const std::string& name) {
  if (name != "hospital") return load_bench_scene(name);
  SensorPose start;
  start.position_m = Hospital::start_m();
  return {name, Scene(Hospital().mesh()), start};
}

void measure(const std::string& name, double share) {
  const BenchScene scene = scene_of(name);
  const Eigen::AlignedBox3d bounds = scene.scene.mesh().bounds_m();
  VisibilityParameters parameters;
  parameters.samples_per_m2 *= share;
  parameters.most_samples =
      static_cast<std::int64_t>(share * static_cast<double>(parameters.most_samples));
  // As of ./run: a lift that reaches 2.8 m.
  const double body_m = BaseLimits{}.body_radius_m;
  parameters.reach.box_min_m = bounds.min() + Eigen::Vector3d(0, 0, body_m);
  parameters.reach.box_max_m = bounds.max();
  parameters.reach.box_max_m.z() = std::min(bounds.max().z() - body_m, bounds.min().z() + 2.8);
  const auto started = std::chrono::steady_clock::now();
  const double before_s = cpu_s();
  reachable_positions(scene.scene, scene.start.position_m, parameters.reach);
  const double reached_s = cpu_s();
  const VisibleSurface surface = visible_surface(scene.scene, scene.start.position_m, parameters);
  const double wall_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  fmt::print(
      "{}: {:.1f} m2, {:.0f} m2 visible; {} triangles, {} positions, {} samples ({:.0f}/m2), "
      "{:.4f} visible\n"
      "  {:.2f} s of CPU for positions, {:.2f} s for all, {:.2f} s by the clock, peak {:.0f} MB, "
      "checksum {:016x}\n",
      name, scene.scene.mesh().area_m2(), surface.area_m2(), scene.scene.mesh().triangles.size(),
      surface.positions, surface.samples, surface.samples_per_m2,
      static_cast<double>(surface.points_m.size()) / static_cast<double>(surface.samples),
      reached_s - before_s, cpu_s() - reached_s, wall_s,
      static_cast<double>(usage.ru_maxrss) / 1024.0, checksum(surface));
}

}  // namespace
}  // namespace nextview

int main(int argc, char** argv) {
  nextview::answer_for_standard_output();
  if (nextview::tell_version(argc, argv)) return 0;
  if (argc < 2 || argc > 3) {
    std::cerr << "usage: nextview_bench_coverage SCENE [SHARE]\n";
    return 2;
  }
  try {
    nextview::measure(argv[1], argc > 2 ? std::atof(argv[2]) : 1.0);
  } catch (const std::exception& error) {
    std::cout << argv[1] << " skipped: " << error.what() << "\n";
  }
  return EXIT_SUCCESS;
}

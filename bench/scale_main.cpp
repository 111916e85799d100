// How the cost of a view grows with what has been explored: real models explored in one process.
//
// nextview_bench_scale SCENE VOXEL_SIZE_M VIEWS

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <vector>

#include "bench/exploration.h"
#include "lcmtypes/standard_output.h"
#include "lcmtypes/tell_version.h"
#include "planner/prediction/fast_view_predictor.h"
#include "planner/prediction/free_space_field.h"
#include "planner/prediction/orientations.h"
#include "reports/median.h"
#include "scene/mesh_file.h"

namespace nextview {

namespace {

double worst(const std::vector<double>& values) {
  return values.empty() ? 0.0 : *std::max_element(values.begin(), values.end());
}

// The costs of the views since the last row.
struct Row {
  std::vector<double> fold_ms;
  std::vector<double> digest_ms;
  std::vector<double> field_ms;
  std::vector<double> decision_ms;
  std::vector<double> evaluations;
};

// Volume of what is known to be Empty or Occupied.
double seen_m3(Exploration& exploration) {
  const MapStatistics statistics = exploration.builder().statistics();
  const std::int64_t seen = statistics.voxels[static_cast<std::size_t>(Label::Empty)] +
                            statistics.voxels[static_cast<std::size_t>(Label::Occupied)];
  return static_cast<double>(seen) * std::pow(exploration.builder().map().grid().voxel_size_m, 3);
}

void print_row(const Row& row, Exploration& exploration, double voxel_size_m) {
  const double voxel_m3 = std::pow(voxel_size_m, 3);
  const double seen = seen_m3(exploration) / voxel_m3;
  const double map_bytes = static_cast<double>(exploration.builder().memory_bytes());
  const double field_bytes =
      static_cast<double>(FreeSpaceField(exploration.builder().map()).memory_bytes());
  fmt::print(
      "{:6} {:9.1f} {:8.2f} {:8.2f} {:8.2f} {:9.2f} {:9.2f} {:6.0f} {:8.1f} {:8.1f} {:8.2f}\n",
      exploration.views(), seen_m3(exploration), median(row.fold_ms), median(row.digest_ms),
      median(row.field_ms), median(row.decision_ms), worst(row.decision_ms),
      median(row.evaluations), map_bytes / 1e6, field_bytes / 1e6,
      (map_bytes + field_bytes) / seen);
  std::fflush(stdout);
}

int explore(const std::string& name, double voxel_size_m, int views) {
  const BenchScene scene = load_bench_scene(name);
  ExplorationParameters parameters;
  parameters.voxel_size_m = voxel_size_m;
  parameters.sensor = sensor_for(std::min(voxel_size_m, 0.02));
  parameters.planner.step_max_m = 3.0;  // larger strides: the point is to see much
  Exploration exploration(scene, parameters);
  const VoxelIndex size = exploration.builder().map().window().size;
  fmt::print("\n{}, {} voxels, window {} x {} x {}, sensor {} x {}, quality off\n", name,
             size_name(voxel_size_m), size[0], size[1], size[2], parameters.sensor.columns,
             parameters.sensor.rows);
  fmt::print("{:>6} {:>9} {:>8} {:>8} {:>8} {:>9} {:>9} {:>6} {:>8} {:>8} {:>8}\n", "view",
             "seen m3", "fold ms", "digest", "field", "decision", "worst", "tried", "map MB",
             "field MB", "B/voxel");
  Row row;
  constexpr int kPatience = 5;  // views that see next to nothing new before the sensor is carried
  int idle_views = 0;
  for (int view = 1; view <= views; ++view) {
    const double before_m3 = seen_m3(exploration);
    const ViewCost cost = exploration.step();
    idle_views = seen_m3(exploration) < 1.002 * before_m3 ? idle_views + 1 : 0;
    if (idle_views == kPatience) {
      exploration.carry_elsewhere();
      idle_views = 0;
    }
    row.fold_ms.push_back(1e3 * cost.fold_s);
    row.digest_ms.push_back(1e3 * cost.digest_s);
    row.field_ms.push_back(1e3 * cost.field_s);
    row.decision_ms.push_back(1e3 * cost.decision_s);
    row.evaluations.push_back(cost.evaluations);
    if (view % std::max(1, views / 10) == 0) {
      print_row(row, exploration, voxel_size_m);
      row = Row();
    }
  }
  return EXIT_SUCCESS;
}

}  // namespace

}  // namespace nextview

int main(int argc, char** argv) {
  nextview::answer_for_standard_output();
  if (nextview::tell_version(argc, argv)) return 0;
  if (argc != 4) {
    std::cerr << "usage: nextview_bench_scale SCENE VOXEL_SIZE_M VIEWS\n";
    return 2;
  }
  try {
    return nextview::explore(argv[1], std::atof(argv[2]), std::atoi(argv[3]));
  } catch (const nextview::SceneError& error) {
    std::cout << "skipped: " << error.what() << "\n";
    return EXIT_SUCCESS;
  }
}

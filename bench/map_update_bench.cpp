// Folding scans of 512 x 256 points into a map that is empty at first, eight of them in a row: so
// every scan meets both new and known space. What a structure needs to start from (points in the
// world; for ours the range image) is made beforehand.

#include <benchmark/benchmark.h>

#include <cmath>
#include <memory>

#include "bench/bench_groups.h"
#include "bench/octomap_map.h"
#include "bench/openvdb_map.h"
#include "bench/recovered_room.h"
#include "bench/stopwatch.h"
#include "bench/textbook_map.h"
#include "mapper/map_builder.h"
#include "mapper/paged_map_builder.h"
#include "mapper/ray_ends.h"
#include "mapper/ray_marking.h"
#include "mapper/reference_map_update.h"

namespace nextview {

namespace {

// The room's scans as points, for those who start from points.
struct PointScan {
  Eigen::Vector3d sensor_m;
  std::vector<Eigen::Vector3d> points_m;
};

std::vector<PointScan> point_scans(const RecoveredRoom& room) {
  std::vector<PointScan> scans;
  for (const RangeImage& image : room.scans()) {
    scans.push_back({image.position_m, sensed_points_m(image)});
  }
  return scans;
}

std::int64_t pixels(const RecoveredRoom& room) {
  return static_cast<std::int64_t>(room.scans().size() * room.scans().front().range_m.size());
}

// Times insert(scan number) over all scans of a fresh map made by make().
template <class Make, class Insert>
benchmark::internal::Benchmark* register_update(const std::string& name, const RecoveredRoom& room,
                                                Make make, Insert insert) {
  return benchmark::RegisterBenchmark(
             ("map_update/" + name + "/" + size_name(room.voxel_size_m())).c_str(),
             [&room, make, insert](benchmark::State& state) {
               for (auto _ : state) {
                 auto map = make();
                 state.SetIterationTime(thread_s([&] {
                   for (std::size_t i = 0; i < room.scans().size(); ++i) insert(*map, i);
                 }));
               }
               state.SetItemsProcessed(state.iterations() * pixels(room));
             })
      ->UseManualTime()
      ->Unit(benchmark::kMillisecond);
}

auto fresh_builder(const RecoveredRoom& room) {
  return [&room] { return std::make_unique<MapBuilder>(room.map().grid(), room.map().window()); };
}

void register_nextview(const RecoveredRoom& room) {
  register_update("nextview", room, fresh_builder(room),
                  [&room](MapBuilder& map, std::size_t i) { map.fold(room.scans()[i]); });
  register_update("nextview_with_digest", room, fresh_builder(room),
                  [&room](MapBuilder& map, std::size_t i) {
                    map.fold(room.scans()[i]);
                    benchmark::DoNotOptimize(map.digest());
                  });
  // The same map, of which 1.6 m each way lie open.
  const auto fresh_paged_map = [&room] {
    const int open = static_cast<int>(std::lround(1.6 / room.voxel_size_m()));
    return std::make_unique<PagedMapBuilder>(room.map().grid(), room.map().window(),
                                             VoxelIndex::Constant(open));
  };
  register_update("nextview_window", room, fresh_paged_map,
                  [&room](PagedMapBuilder& map, std::size_t i) { map.fold(room.scans()[i]); });
  const auto fresh_map = [&room] {
    return std::make_unique<VoxelMap>(room.map().grid(), room.map().window());
  };
  // From distinct ray ends to labels.
  const auto ends = std::make_shared<std::vector<RayEnds>>(room.scans().size());
  for (std::size_t i = 0; i < ends->size(); ++i) {
    (*ends)[i].collect(room.scans()[i], room.map().grid(), room.map().window());
  }
  const auto changed = std::make_shared<std::vector<std::uint32_t>>();
  const auto mark = [&room, changed](VoxelMap& map, std::size_t i, const RayEnds& of_scan) {
    changed->clear();
    mark_rays(map, map.grid().voxel_of(room.scans()[i].position_m), of_scan.ends(),
              of_scan.shadows(), *changed);
  };
  register_update("nextview_marking", room, fresh_map,
                  [mark, ends](VoxelMap& map, std::size_t i) { mark(map, i, (*ends)[i]); });
  // From the range image to labels, with points, normals and quality, without occlusion planes.
  register_update(
      "nextview_points_and_marking", room, fresh_map,
      [&room, mark, collected = std::make_shared<RayEnds>()](VoxelMap& map, std::size_t i) {
        collected->collect(room.scans()[i], map.grid(), map.window());
        mark(map, i, *collected);
      });
}

void register_competitors(const RecoveredRoom& room) {
  const auto scans = std::make_shared<const std::vector<PointScan>>(point_scans(room));
  const VoxelGrid grid = room.map().grid();
  const MapWindow window = room.map().window();
  register_update(
      "textbook", room, [=] { return std::make_unique<TextbookMap>(grid, window); },
      [scans](TextbookMap& map, std::size_t i) {
        map.insert((*scans)[i].sensor_m, (*scans)[i].points_m);
      });
  for (const bool occluded : {true, false}) {
    register_update(
        occluded ? "openvdb" : "openvdb_without_occluded", room,
        [=] { return std::make_unique<OpenvdbMap>(grid, window); },
        [scans, occluded](OpenvdbMap& map, std::size_t i) {
          map.insert((*scans)[i].sensor_m, (*scans)[i].points_m, occluded);
        });
  }
  using Insertion = OctomapMap::Insertion;
  const auto clouds = std::make_shared<std::vector<OctomapMap::Cloud>>();
  for (const PointScan& scan : *scans) {
    clouds->emplace_back(scan.sensor_m, scan.points_m, grid.voxel_size_m);
  }
  for (const auto& [name, insertion] :
       {std::pair{"octomap", Insertion::DiscretizedLazy},
        std::pair{"octomap_with_inner_nodes", Insertion::DiscretizedLazyThenInner},
        std::pair{"octomap_exact", Insertion::Exact}}) {
    register_update(
        name, room, [grid] { return std::make_unique<OctomapMap>(grid.voxel_size_m); },
        [clouds, how = insertion](OctomapMap& map, std::size_t i) {
          map.insert((*clouds)[i], how);
        });
  }
}

// Cost against what has been mapped before: a hall with room for a hundred of our rooms, of which
// some are mapped; then one more.
void register_explored(const RecoveredRoom& room, int rooms_before, bool with_digest) {
  const std::string name = std::string("nextview_") + (with_digest ? "with_digest_" : "") +
                           "after_" + std::to_string(rooms_before) +
                           (rooms_before == 1 ? "_room" : "_rooms");
  benchmark::RegisterBenchmark(
      ("map_update/" + name + "/" + size_name(room.voxel_size_m())).c_str(),
      [&room, rooms_before, with_digest](benchmark::State& state) {
        constexpr int kRoomsPerSide = 10;
        const VoxelIndex pitch = room.map().window().size;
        MapWindow hall = room.map().window();
        hall.size[0] *= kRoomsPerSide;
        hall.size[1] *= kRoomsPerSide + 1;  // the last row is where the timed room lies
        const auto moved = [&](const RangeImage& image, int column, int row) {
          RangeImage there = image;
          there.position_m +=
              room.voxel_size_m() * Eigen::Vector3d(column * pitch[0], row * pitch[1], 0.0);
          there.pose.position_m = there.position_m;
          return there;
        };
        double explored_m3 = 0.0;
        std::size_t changed = 0;
        for (auto _ : state) {
          MapBuilder map(room.map().grid(), hall);
          for (int i = 0; i < rooms_before; ++i) {
            for (const RangeImage& image : room.scans()) {
              map.fold(moved(image, i % kRoomsPerSide, i / kRoomsPerSide));
            }
          }
          benchmark::DoNotOptimize(map.digest());
          const MapStatistics before = map.statistics();
          explored_m3 = static_cast<double>(before.voxels[static_cast<std::size_t>(Label::Empty)]) *
                        std::pow(room.voxel_size_m(), 3);
          double elapsed_s = 0.0;
          changed = 0;
          for (const RangeImage& image : room.scans()) {
            const RangeImage there = moved(image, 0, kRoomsPerSide);
            elapsed_s += thread_s([&] {
              changed += map.fold(there).changed_slots.size();
              if (with_digest) benchmark::DoNotOptimize(map.digest());
            });
          }
          state.SetIterationTime(elapsed_s);
        }
        state.SetItemsProcessed(state.iterations() * pixels(room));
        state.counters["explored_m3"] = explored_m3;
        state.counters["changed_voxels"] = static_cast<double>(changed);
      })
      ->UseManualTime()
      ->Iterations(1)
      ->Unit(benchmark::kMillisecond);
}

// The labels after the first scans, voxel by voxel.
void compare_maps(const RecoveredRoom& room) {
  constexpr std::size_t kScans = 3;
  const VoxelGrid grid = room.map().grid();
  const MapWindow window = room.map().window();
  MapBuilder ours(grid, window);
  ReferenceMapUpdate plain(grid, window);
  TextbookMap textbook(grid, window);
  OpenvdbMap openvdb(grid, window);
  OctomapMap octomap(grid.voxel_size_m);
  for (std::size_t i = 0; i < kScans; ++i) {
    const RangeImage& image = room.scans()[i];
    const auto points_m = sensed_points_m(image);
    ours.fold(image);
    plain.fold(image);
    textbook.insert(image.position_m, points_m);
    openvdb.insert(image.position_m, points_m, true);
    octomap.insert({image.position_m, points_m, grid.voxel_size_m},
                   OctomapMap::Insertion::DiscretizedLazy);
  }

  const std::string prefix = "map_update/" + size_name(room.voxel_size_m());
  Agreement with_plain(prefix + " nextview = plain");
  Agreement with_textbook(prefix + " textbook = nextview");
  Agreement openvdb_with_textbook(prefix + " openvdb = textbook");
  Agreement with_octomap(prefix + " octomap = nextview");
  for (int k = 0; k < window.size[2]; ++k) {
    for (int j = 0; j < window.size[1]; ++j) {
      for (int i = 0; i < window.size[0]; ++i) {
        const VoxelIndex voxel = window.min + VoxelIndex(i, j, k);
        const Label label = ours.map().label(voxel);
        with_plain.compare(label == plain.label(voxel));
        const Label mark = label == Label::OcclusionPlane ? Label::Occluded : label;
        const Label by_textbook = textbook.labels().at(voxel);
        const Label by_octomap = octomap.label(voxel);
        const Label known = mark == Label::Occluded ? Label::Unmarked : mark;
        if (mark != Label::Unmarked || by_textbook != Label::Unmarked) {
          with_textbook.compare(by_textbook == mark);
          openvdb_with_textbook.compare(openvdb.label(voxel) == by_textbook);
        }
        if (known != Label::Unmarked || by_octomap != Label::Unmarked) {
          with_octomap.compare(by_octomap == known);
        }
      }
    }
  }
  with_plain.report_and_require_none("voxels");
  with_textbook.report("marked voxels", "walks from the sensor's position, not its voxel's centre");
  openvdb_with_textbook.report("marked voxels");
  with_octomap.report("Empty or Occupied voxels",
                      "OctoMap lets misses win over hits and has no Occluded");
}

}  // namespace

void register_map_update(const BenchOptions& options) {
  for (const double voxel_size_m : options.voxel_sizes_m()) {
    const RecoveredRoom& room = recovered_room(voxel_size_m);
    compare_maps(room);
    register_nextview(room);
    register_competitors(room);
    if (voxel_size_m < 0.05) continue;  // minutes
    register_update(
        "plain", room,
        [&room] {
          return std::make_unique<ReferenceMapUpdate>(room.map().grid(), room.map().window());
        },
        [&room](ReferenceMapUpdate& map, std::size_t i) { map.fold(room.scans()[i]); });
  }
  const RecoveredRoom& room = recovered_room(options.quick ? 0.10 : 0.05);
  for (const int rooms : {1, 10, 100}) {
    register_explored(room, rooms, false);
    register_explored(room, rooms, true);
  }
}

}  // namespace nextview

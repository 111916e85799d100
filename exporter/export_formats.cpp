#include "exporter/export_formats.h"

#include <fstream>
#include <stdexcept>

#include "exporter/mesh_writer.h"
#include "exporter/octree_file.h"
#include "exporter/one_voxel_holes.h"
#include "exporter/oriented_points.h"
#include "exporter/point_clouds.h"
#include "exporter/recovered_mesh.h"
#include "exporter/run_mcap.h"
#include "exporter/trajectory.h"
#include "reports/run_report.h"

namespace nextview {
namespace {

using Write = std::function<void(std::ostream&)>;

/// @throws std::runtime_error naming the file when it cannot be written in whole
void write_file(const std::filesystem::path& file, const Write& write) {
  std::ofstream out(file, std::ios::binary);
  if (!out) throw std::runtime_error(file.string() + ": cannot be written; does its folder exist?");
  write(out);
  out.flush();
  if (!out) throw std::runtime_error(file.string() + ": could not be written in whole; disk full?");
}

std::vector<const RangeImage*> images_of(const RecoveredRun& run) {
  std::vector<const RangeImage*> images;
  for (const ReceivedRangeImage* received : run.images) images.push_back(&received->image);
  return images;
}

std::vector<StampedPose> poses_of(const RecoveredRun& run) {
  std::vector<StampedPose> poses;
  for (const ReceivedRangeImage* received : run.images) {
    poses.push_back({received->view, static_cast<double>(received->utime) * 1e-6,
                     received->image.position_m, received->image.world_from_sensor});
  }
  return poses;
}

/// The table of a run, as ./run writes it but for what the CAD model has to say.
void write_views_of(const RecoveredRun& run, const ExportOptions& options, std::ostream& out) {
  // The rows take the range images out of the record, which others still need.
  RunLog log(log_file_of(options.folder_or_log), options.run, RangeImages::Keep);
  log.read_on();
  ViewRows rows(run.config());
  while (rows.rows().size() < run.images.size() && rows.advance(log.record()) != nullptr) {
  }
  rows.complete(log.record());
  FinishedRun finished;
  finished.config = run.config();
  finished.rows = rows.rows();
  write_views(out, finished);
}

SurfaceMesh mesh_of(const RecoveredRun& run, const ExportOptions& options) {
  OrientedPoints points(run.builder.map().grid());
  for (const RangeImage* image : images_of(run)) points.add(*image);
  return simplified(recovered_mesh(run.builder.map(), points), options.simplify);
}

template <class WriteRun>
ExportFormat stream_format(const std::string& name, const std::string& description,
                           WriteRun write_run) {
  return {name, description,
          [write_run](RecoveredRun& run, const ExportOptions& options,
                      const std::filesystem::path& file) {
            write_file(file, [&](std::ostream& out) { write_run(run, options, out); });
          }};
}

std::vector<ExportFormat> make_formats() {
  std::vector<ExportFormat> formats;
  for (const auto& [ending, format] :
       {std::pair("ply", PointFormat::Ply), std::pair("pcd", PointFormat::Pcd)}) {
    formats.push_back(stream_format(
        std::string("voxels.") + ending, "Occupied voxels: centre, normal, quality",
        [format = format](RecoveredRun& run, const ExportOptions& options, std::ostream& out) {
          const VoxelMap& map = run.builder.map();
          if (options.fill_holes) {
            write_filled_voxels(out, format, map, one_voxel_holes(map));
          } else {
            write_occupied_voxels(out, format, map);
          }
        }));
    formats.push_back(stream_format(
        std::string("points.") + ending, "sensed points: position, normal, view",
        [format = format](RecoveredRun& run, const ExportOptions&, std::ostream& out) {
          write_sensed_points(out, format, images_of(run));
        }));
  }
  for (const auto& [ending, format] :
       {std::pair("ply", MeshFormat::Ply), std::pair("obj", MeshFormat::Obj),
        std::pair("gltf", MeshFormat::Gltf), std::pair("glb", MeshFormat::Glb)}) {
    formats.push_back({std::string("mesh.") + ending, "the seen surface in triangles",
                       [format = format](RecoveredRun& run, const ExportOptions& options,
                                         const std::filesystem::path& file) {
                         write_mesh(mesh_of(run, options), format, file);
                       }});
  }
  formats.push_back(
      {"octomap.bt", "the map as OctoMap's binary tree",
       [](RecoveredRun& run, const ExportOptions& options, const std::filesystem::path& file) {
         const VoxelMap& map = run.builder.map();
         write_octree(map, options.fill_holes ? one_voxel_holes(map) : std::vector<VoxelIndex>(),
                      file);
       }});
  formats.push_back(stream_format("run.mcap", "the run for Foxglove and Lichtblick",
                                  [](RecoveredRun& run, const ExportOptions&, std::ostream& out) {
                                    write_run_mcap(out, run);
                                  }));
  formats.push_back(stream_format("poses.csv", "sensor poses, a row a view",
                                  [](RecoveredRun& run, const ExportOptions&, std::ostream& out) {
                                    write_poses_csv(out, poses_of(run));
                                  }));
  formats.push_back(stream_format("poses.tum", "sensor poses as a TUM trajectory",
                                  [](RecoveredRun& run, const ExportOptions&, std::ostream& out) {
                                    write_poses_tum(out, poses_of(run));
                                  }));
  formats.push_back(stream_format(
      "views.csv",
      "the run's table without surface_coverage and surface_precision, which need the CAD model",
      [](RecoveredRun& run, const ExportOptions& options, std::ostream& out) {
        write_views_of(run, options, out);
      }));
  return formats;
}

}  // namespace

const std::vector<ExportFormat>& export_formats() {
  static const std::vector<ExportFormat> kFormats = make_formats();
  return kFormats;
}

}  // namespace nextview

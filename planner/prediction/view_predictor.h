#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mapper/integer_line.h"
#include "planner/prediction/known_space.h"
#include "planner/prediction/orientations.h"
#include "planner/prediction/predicted_quality.h"
#include "planner/prediction/view_counts.h"
#include "sensor/sensor_geometry.h"

namespace nextview {

/// The rays a view is predicted with.
struct PredictionRaster {
  RayTable rays;
  double range_max_m = 30.0;  ///< a ray is open when it meets only Empty up to this distance
};

/// How many rays a view is predicted with at most, of the sensor's picture (P5).
struct PredictionRays {
  int columns = 64;
  int rows = 32;
};

/// The sensor's own rays, or with a larger sensor as many of them as is said, spread evenly over
/// the same apertures.
/// @throws std::invalid_argument for a sensor or numbers of rays that cannot be
PredictionRaster prediction_raster(const SensorGeometry& sensor, const RangeLimits& limits,
                                   const PredictionRays& at_most = {});

/// How far a ray of the raster goes, in voxels: its range, at least 1 and at most
/// IntegerLine::kMaxSteps.
double prediction_reach(const PredictionRaster& raster, double voxel_size_m);

/// Says what the rays of every orientation would meet from a voxel.
///
/// A ray is the integer line from the sensor's voxel along R n_uv with a reach of
/// range_max_m / voxel_size_m voxels (at least 1, at most IntegerLine::kMaxSteps). Of its voxels
/// k = 1, 2, ... as far as the reach and the window go, the first that is not Empty decides; when
/// there is none the ray is open.
class ViewPredictor {
 public:
  virtual ~ViewPredictor() = default;

  const std::vector<Orientation>& orientations() const { return orientations_; }
  /// Whether ViewCounts' surface counts are wanted (f_quality, f_structure).
  bool counts_surfaces() const { return counts_surfaces_; }

  /// Fills the counts of every orientation, in the order of orientations().
  /// @throws std::invalid_argument when the sensor's voxel lies outside the window, or the number
  ///         of counts or the map's voxel size is not what the predictor was made for
  /// @throws std::logic_error when surfaces are counted and the space keeps none
  virtual void predict(const KnownSpace& space, const VoxelIndex& sensor,
                       std::span<ViewCounts> per_orientation) = 0;

  /// The same for several sensors: the counts of all orientations for the first, then for the
  /// second, and so on. With threads that takes less time than one after the other.
  /// @throws what predict() does; std::invalid_argument also unless there are as many counts as
  ///         sensors times orientations
  virtual void predict_all(const KnownSpace& space, std::span<const VoxelIndex> sensors,
                           std::span<ViewCounts> counts);

  /// The same for orientations that are named a few at a time: first the voxel, then the questions.
  /// A predictor that can works out no more than is asked for; this one all of them.
  /// The space must outlive the questions and not change meanwhile.
  /// @throws what predict() does
  virtual void look_from(const KnownSpace& space, const VoxelIndex& sensor);
  /// Fills the counts of some orientations, by their places in orientations(), from where it was
  /// looked from last.
  /// @throws std::invalid_argument unless there are as many counts as orientations
  virtual void count(std::span<const std::size_t> which, std::span<ViewCounts> counts);

 protected:
  ViewPredictor(std::vector<Orientation> orientations, bool counts_surfaces)
      : orientations_(std::move(orientations)), counts_surfaces_(counts_surfaces) {}
  /// Throws what predict_all() promises of the number of counts.
  void check_count(std::size_t sensors, std::size_t counts) const;
  /// Throws what count() promises.
  static void check_asked(std::size_t orientations, std::size_t counts);

  ViewPredictor(const ViewPredictor&) = default;
  ViewPredictor& operator=(const ViewPredictor&) = default;

 private:
  std::vector<Orientation> orientations_;
  bool counts_surfaces_;
  std::vector<ViewCounts> from_there_;  // by orientation, of the last look_from()
};

/// A predictor that tabulates the rays of a raster for voxels of one size.
class RasterViewPredictor : public ViewPredictor {
 protected:
  /// @throws std::invalid_argument when there are no orientations or rays, or a length is not
  ///         positive
  RasterViewPredictor(const PredictionRaster& raster, double voxel_size_m,
                      std::vector<Orientation> orientations, bool counts_surfaces);

  /// Throws what predict() promises.
  void check_arguments(const VoxelMap& map, const VoxelIndex& sensor, std::size_t counts) const;

 private:
  double voxel_size_m_;
};

/// The obvious predictor: one ray after the other, one voxel after the other.
class PlainViewPredictor : public RasterViewPredictor {
 public:
  /// @throws std::invalid_argument when there are no orientations or rays, or a length is not
  ///         positive
  PlainViewPredictor(const PredictionRaster& raster, double voxel_size_m,
                     std::vector<Orientation> orientations, bool counts_surfaces);
  /// With other rays than the raster's, as many of them for each orientation.
  /// @param rays by orientation; unit vectors of the world frame
  /// @throws std::invalid_argument also unless there are as many
  PlainViewPredictor(const PredictionRaster& raster, double voxel_size_m,
                     std::vector<Orientation> orientations, bool counts_surfaces,
                     std::span<const Eigen::Vector3d> rays);

  void predict(const KnownSpace& space, const VoxelIndex& sensor,
               std::span<ViewCounts> per_orientation) override;
  void look_from(const KnownSpace& space, const VoxelIndex& sensor) override;
  void count(std::span<const std::size_t> which, std::span<ViewCounts> counts) override;

 private:
  struct Ray {
    IntegerLine line;              // from voxel (0, 0, 0)
    QuantisedDirection direction;  // world frame
  };
  struct Sighting {  // an Occupied voxel met by a ray
    VoxelIndex voxel;
    std::int32_t cosine;
  };

  static std::vector<Eigen::Vector3d> rays_of(const RayTable& rays,
                                              std::span<const Orientation> orientations);
  ViewCounts predict_view(const VoxelMap& map, const VoxelIndex& sensor, std::span<const Ray> rays);
  void count_surfaces(const VoxelMap& map, ViewCounts& counts);

  std::span<const Ray> rays_of_view(std::size_t orientation) const {
    return std::span(rays_).subspan(orientation * rays_per_view_, rays_per_view_);
  }

  std::size_t rays_per_view_;
  std::vector<Ray> rays_;          // by orientation, then by pixel
  const VoxelMap* map_ = nullptr;  // of the last look_from()
  VoxelIndex sensor_ = VoxelIndex::Zero();
  std::vector<Sighting> sightings_;  // of the view at hand
};

}  // namespace nextview

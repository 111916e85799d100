#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <span>
#include <vector>

#include "mapper/integer_line.h"
#include "mapper/voxel_map.h"
#include "planner/prediction/orientations.h"
#include "planner/prediction/view_counts.h"
#include "sensor/sensor_geometry.h"

namespace nextview {

/// The rays a view is predicted with.
struct PredictionRaster {
  RayTable rays;
  double range_max_m = 30.0;  ///< a ray is open when it meets only Empty up to this distance
};

/// The sensor's own rays, or with a larger sensor 64 x 32 of them at most, spread evenly over the
/// same apertures (P5).
PredictionRaster prediction_raster(const TiltedLineScan& sensor, const RangeLimits& limits);

/// How far a ray of the raster goes, in voxels: its range, at least 1 and at most
/// IntegerLine::kMaxSteps.
double prediction_reach(const PredictionRaster& raster, double voxel_size_m);

/// The quality of a predicted view of a voxel (P9, P17) in integers, so that every way of computing
/// it gives the same. The voxel's mean normal and the ray's direction are rounded to multiples of
/// 1/SurfaceVoxel::kNormalUnit; |normal . ray| is then an integer of 1/2^28, of which the largest
/// over a view's rays is taken, and that is rounded to 1/SurfaceVoxel::kQualityUnit.
using QuantisedDirection = std::array<std::int16_t, 3>;
/// Rounds a vector of length <= 1; halves go away from zero.
QuantisedDirection quantise_direction(const Eigen::Vector3d& direction);
/// |normal . ray|, 1/2^28; below 2^29 for rounded unit vectors, and no intermediate sum is larger.
inline std::int32_t quantised_cosine(const QuantisedDirection& normal,
                                     const QuantisedDirection& ray) {
  return std::abs(normal[0] * ray[0] + normal[1] * ray[1] + normal[2] * ray[2]);
}
/// min(kQualityUnit, round(cosine * kQualityUnit / 2^28)).
std::uint16_t predicted_quality(std::int32_t cosine);

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
  /// Whether ViewCounts' surface counts are wanted (f_quality).
  bool counts_quality() const { return counts_quality_; }

  /// Fills the counts of every orientation, in the order of orientations().
  /// @throws std::invalid_argument when the sensor's voxel lies outside the window, or the number
  ///         of counts or the map's voxel size is not what the predictor was made for
  virtual void predict(const VoxelMap& map, const VoxelIndex& sensor,
                       std::span<ViewCounts> per_orientation) = 0;

  /// The same for several sensors: the counts of all orientations for the first, then for the
  /// second, and so on. With threads that takes less time than one after the other.
  /// @param meanwhile what this thread has to do before it takes part, such as finding out where to
  ///        predict next
  /// @throws std::invalid_argument as predict() does, also unless there are as many counts as
  ///         sensors times orientations
  virtual void predict_all(
      const VoxelMap& map, std::span<const VoxelIndex> sensors, std::span<ViewCounts> counts,
      const std::function<void()>& meanwhile = [] {});

  /// To be called after every change of the map, with the slots whose label is different and those
  /// whose surface data is (FoldReport has both), and after every move of its window with what
  /// MapBuilder::move_window says; a predictor may keep what it derives from them up to date. It
  /// must be the same map.
  virtual void map_changed(const VoxelMap& map, std::span<const std::uint32_t> changed_slots,
                           std::span<const std::uint32_t> updated_surfaces) = 0;

  /// A by-product for FeasibleSpace::FreeDistance, of the map last predicted in or told of: how
  /// near to a voxel of its window everything is Empty, or 0 when the predictor does not know.
  virtual int free_distance(const VoxelIndex&) const { return 0; }

 protected:
  ViewPredictor(std::vector<Orientation> orientations, bool counts_quality)
      : orientations_(std::move(orientations)), counts_quality_(counts_quality) {}
  /// Throws what predict_all() promises of the number of counts.
  void check_count(std::size_t sensors, std::size_t counts) const;

  ViewPredictor(const ViewPredictor&) = default;
  ViewPredictor& operator=(const ViewPredictor&) = default;

 private:
  std::vector<Orientation> orientations_;
  bool counts_quality_;
};

/// A predictor that tabulates the rays of a raster for voxels of one size.
class RasterViewPredictor : public ViewPredictor {
 protected:
  /// @throws std::invalid_argument when there are no orientations or rays, or a length is not
  ///         positive
  RasterViewPredictor(const PredictionRaster& raster, double voxel_size_m,
                      std::vector<Orientation> orientations, bool counts_quality);

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
                     std::vector<Orientation> orientations, bool counts_quality);

  void predict(const VoxelMap& map, const VoxelIndex& sensor,
               std::span<ViewCounts> per_orientation) override;
  void map_changed(const VoxelMap&, std::span<const std::uint32_t>,
                   std::span<const std::uint32_t>) override {}

 private:
  struct Ray {
    IntegerLine line;              // from voxel (0, 0, 0)
    QuantisedDirection direction;  // world frame
  };
  struct Sighting {  // an Occupied voxel met by a ray
    VoxelIndex voxel;
    std::int32_t cosine;
  };

  ViewCounts predict_view(const VoxelMap& map, const VoxelIndex& sensor, std::span<const Ray> rays);
  void count_improvements(const VoxelMap& map, ViewCounts& counts);

  std::size_t rays_per_view_;
  std::vector<Ray> rays_;            // by orientation, then by pixel
  std::vector<Sighting> sightings_;  // of the view at hand
};

}  // namespace nextview

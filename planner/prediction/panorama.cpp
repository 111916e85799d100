#include "planner/prediction/panorama.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mapper/integer_line.h"
#include "sensor/sensor_pose.h"

namespace nextview {

namespace {

constexpr int kSide = Panorama::kSide;
constexpr std::size_t kCellsOfFace = static_cast<std::size_t>(kSide) * kSide;

RayBundle rays_of_face(int face, double reach) {
  RayBundle bundle;
  bundle.driving_axis = face / 2;
  bundle.direction = face % 2 == 0 ? 1 : -1;
  bundle.packets.resize(kCellsOfFace / RayBundle::kPacketRays);
  bundle.group.resize(bundle.packets.size());
  for (std::size_t ray = 0; ray < kCellsOfFace; ++ray) {
    const int cell = face * static_cast<int>(kCellsOfFace) + static_cast<int>(ray);
    const IntegerLine line = line_along(VoxelIndex::Zero(), Panorama::direction(cell), reach);
    // Rounding can make a cell at the very rim a tie between two driving axes, but no other axis
    // ever advances more than the face's.
    RayBundle::Packet& packet = bundle.packets[ray / RayBundle::kPacketRays];
    const std::size_t place = ray % RayBundle::kPacketRays;
    packet.slope1[place] = line.slope[(bundle.driving_axis + 1) % 3];
    packet.slope2[place] = line.slope[(bundle.driving_axis + 2) % 3];
    packet.reach[place] = line.steps;
  }
  return bundle;
}

// What a sensor sees, half a pixel beyond its outermost rays.
class Aperture {
 public:
  explicit Aperture(const RayTable& rays)
      : lines_from_sensor_(sensor_from_lines(rays.kind).transpose()) {
    const auto range = [](const std::vector<double>& sines, const std::vector<double>& cosines) {
      double min = std::atan2(sines.back(), cosines.back());
      double max = std::atan2(sines.front(), cosines.front());
      if (min > max) std::swap(min, max);
      const double half_pixel = 0.5 * (max - min) / static_cast<double>(sines.size() - 1);
      return std::array{min - half_pixel, max + half_pixel};
    };
    const auto [column_min, column_max] = range(rays.column_sin, rays.column_cos);
    const auto [row_min, row_max] = range(rays.row_sin, rays.row_cos);
    sin_min_ = std::sin(column_min);
    sin_max_ = std::sin(column_max);
    rows_in_front_ = std::max(-row_min, row_max) < std::numbers::pi / 2.0;
    tan_min_ = std::tan(row_min);
    tan_max_ = std::tan(row_max);
    row_min_ = row_min;
    row_max_ = row_max;
  }

  // A unit vector of the sensor frame. In the line frame -x is the sine of its column's angle, and
  // the angle of its row is that of y and z.
  bool contains(const Eigen::Vector3d& direction) const {
    const Eigen::Vector3d n = lines_from_sensor_ * direction;
    return -n.x() >= sin_min_ && -n.x() <= sin_max_ && is_in_rows(n.y(), n.z());
  }

 private:
  bool is_in_rows(double y, double z) const {
    if (rows_in_front_) return y > 0.0 && z >= tan_min_ * y && z <= tan_max_ * y;
    constexpr double kRounding = 1e-9;  // where the rows of a whole turn meet
    const double angle = std::atan2(z, y);
    return angle >= row_min_ - kRounding && angle <= row_max_ + kRounding;
  }

  Eigen::Matrix3d lines_from_sensor_;
  double sin_min_, sin_max_;
  bool rows_in_front_;  // all of them, so that tangents tell them apart
  double tan_min_, tan_max_;
  double row_min_, row_max_;
};

}  // namespace

Eigen::Vector3d Panorama::direction(int cell) {
  const auto slope = [](int i) {
    return std::tan(std::numbers::pi / 4.0 * ((2 * i + 1.0) / kSide - 1.0));
  };
  const int face = cell / static_cast<int>(kCellsOfFace);
  const int axis = face / 2;
  Eigen::Vector3d direction;
  direction[axis] = face % 2 == 0 ? 1.0 : -1.0;
  direction[(axis + 1) % 3] = slope(cell % kSide);
  direction[(axis + 2) % 3] = slope(cell / kSide % kSide);
  return direction.normalized();
}

Panorama::Panorama(double reach) {
  for (int face = 0; face < 6; ++face) {
    faces_[static_cast<std::size_t>(face)] = rays_of_face(face, reach);
  }
}

void Panorama::cast(const FreeSpaceField& field, const VoxelIndex& sensor,
                    std::span<std::int32_t> met_at) const {
  for (std::size_t face = 0; face < faces_.size(); ++face) {
    PacketQueue packets;
    packets.refill(faces_[face].packets.size(), faces_[face].packets.size());
    RayOutcomes outcomes;
    outcomes.met_at = &met_at[face * kCellsOfFace];
    cast_bundle(field.bytes(), field.shifts(), static_cast<std::int32_t>(field.offset(sensor)),
                field.steps_from(sensor), faces_[face], packets, outcomes);
  }
}

PanoramaViews::PanoramaViews(const RayTable& rays, std::span<const Orientation> orientations) {
  const Aperture aperture(rays);
  std::vector<Eigen::Vector3d> directions;
  for (int cell = 0; cell < Panorama::kCells; ++cell)
    directions.push_back(Panorama::direction(cell));
  begins_ = {0};
  for (const Orientation& orientation : orientations) {
    const Eigen::Matrix3d sensor_from_world =
        world_from_sensor_rotation(orientation.pan_rad, orientation.tilt_rad).transpose();
    int cells = 0;
    for (int row = 0; row < Panorama::kRows; ++row) {
      const auto sees = [&](int column) {
        const auto cell = static_cast<std::size_t>(row * kSide + column);
        return aperture.contains(sensor_from_world * directions[cell]);
      };
      for (int column = 0; column < kSide; ++column) {
        if (!sees(column)) continue;
        int end = column + 1;
        while (end < kSide && sees(end)) ++end;
        const int first = row * (kSide + 1);
        runs_.push_back(
            {static_cast<std::uint16_t>(first + column), static_cast<std::uint16_t>(first + end)});
        cells += end - column;
        column = end;
      }
    }
    begins_.push_back(runs_.size());
    cells_.push_back(cells);
  }
}

void PanoramaViews::sum_rows(std::span<const std::int32_t> values, RowSums& sums) {
  const std::int32_t* value = values.data();
  std::int32_t* sum = sums.data();
  for (int row = 0; row < Panorama::kRows; ++row) {
    std::int32_t total = 0;
    *sum++ = 0;
    for (int column = 0; column < kSide; ++column) *sum++ = total += *value++;
  }
}

}  // namespace nextview

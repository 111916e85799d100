#include "planner/prediction/panorama.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "mapper/integer_line.h"
#include "sensor/elementary_functions.h"
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
      double min = elementary::atan2(sines.back(), cosines.back());
      double max = elementary::atan2(sines.front(), cosines.front());
      if (min > max) std::swap(min, max);
      const double half_pixel = 0.5 * (max - min) / static_cast<double>(sines.size() - 1);
      return std::array{min - half_pixel, max + half_pixel};
    };
    const auto [column_min, column_max] = range(rays.column_sin, rays.column_cos);
    const auto [row_min, row_max] = range(rays.row_sin, rays.row_cos);
    sin_min_ = elementary::sin(column_min);
    sin_max_ = elementary::sin(column_max);
    rows_in_front_ = std::max(-row_min, row_max) < std::numbers::pi / 2.0;
    tan_min_ = elementary::tan(row_min);
    tan_max_ = elementary::tan(row_max);
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
    const double angle = elementary::atan2(z, y);
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
  static const std::array<double, kSide> slopes = [] {
    std::array<double, kSide> result{};
    for (int i = 0; i < kSide; ++i) {
      result[static_cast<std::size_t>(i)] =
          elementary::tan(std::numbers::pi / 4.0 * ((2 * i + 1.0) / kSide - 1.0));
    }
    return result;
  }();
  const auto slope = [](int i) { return slopes[static_cast<std::size_t>(i)]; };
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

namespace {

constexpr std::size_t kPacketsOfRow = kSide / Panorama::kPacketCells;
constexpr std::size_t kPacketsOfFace = kSide * kPacketsOfRow;
constexpr std::size_t kPackets = 6 * kPacketsOfFace;
constexpr std::uint64_t kPacket = (std::uint64_t{1} << Panorama::kPacketCells) - 1;

// A packet's first cell in its row.
constexpr std::size_t first_of(std::size_t packet) {
  return packet % kPacketsOfRow * Panorama::kPacketCells;
}

// Of a face's rows or columns the first and the last whose slopes are between these, and maybe one
// more on either side; first > last when there are none.
std::array<int, 2> cells_between(double min_slope, double max_slope) {
  // By slope from -1 to 1 the cell in which it lies.
  constexpr int kSlopes = 1024;
  constexpr double kHalfOfThem = kSlopes / 2.0;
  static const std::array<std::int8_t, kSlopes + 1> cells = [] {
    std::array<std::int8_t, kSlopes + 1> result{};
    for (int i = 0; i <= kSlopes; ++i) {
      const double angle = elementary::atan(2.0 * i / kSlopes - 1.0) / (std::numbers::pi / 4.0);
      result[static_cast<std::size_t>(i)] = static_cast<std::int8_t>((angle + 1.0) * kSide / 2.0);
    }
    return result;
  }();
  constexpr double kSlack = 0.001;  // slopes of rays are rounded
  if (max_slope < -1.0 - kSlack || min_slope > 1.0 + kSlack) return {1, 0};
  const auto cell = [&](double slope) {
    const double at = (std::clamp(slope, -1.0, 1.0) + 1.0) * kHalfOfThem;
    return int{cells[static_cast<std::size_t>(at)]};
  };
  return {std::max(0, cell(min_slope - kSlack) - 1),
          std::min(kSide - 1, cell(max_slope + kSlack) + 1)};
}

// Of a face's rows of cells as the ray kernel wants them: bit i % 8 of byte i / 8.
static_assert(std::endian::native == std::endian::little);
std::uint8_t* bits_of_face(Panorama::Cells& cells, std::size_t face) {
  return reinterpret_cast<std::uint8_t*>(&cells[face * kSide]);
}

RayOutcomes outcomes_of_face(Panorama::Met& met, std::size_t face) {
  RayOutcomes outcomes;
  outcomes.met_at = &met.at[face * kCellsOfFace];
  outcomes.occupied = bits_of_face(met.occupied, face);
  outcomes.occlusion_plane = bits_of_face(met.plane, face);
  outcomes.unseen = bits_of_face(met.unseen, face);
  return outcomes;
}

void cast_all(const RayBundle& bundle, const FreeSpaceField& field, const VoxelIndex& sensor,
              const RayOutcomes& outcomes) {
  PacketQueue packets;
  packets.refill(bundle.packets.size(), bundle.packets.size());
  cast_bundle(field.bytes(), field.shifts(), static_cast<std::int32_t>(field.offset(sensor)),
              field.steps_from(sensor), bundle, packets, outcomes);
}

}  // namespace

void Panorama::cast(const FreeSpaceField& field, const VoxelIndex& sensor, const Packets& packets,
                    Met& met) const {
  met.occupied = met.plane = met.unseen = {};
  constexpr std::size_t kWordsOfFace = kPacketsOfFace / 64;
  RayBundle some;
  std::vector<std::size_t> chosen;
  Met of_chosen;
  for (std::size_t face = 0; face < faces_.size(); ++face) {
    chosen.clear();
    some.packets.clear();
    for (std::size_t word = face * kWordsOfFace; word < (face + 1) * kWordsOfFace; ++word) {
      for (std::uint64_t bits = packets[word]; bits != 0; bits &= bits - 1) {
        chosen.push_back(word * 64 + static_cast<std::size_t>(std::countr_zero(bits)));
        some.packets.push_back(faces_[face].packets[chosen.back() % kPacketsOfFace]);
      }
    }
    if (chosen.empty()) continue;
    if (chosen.size() == kPacketsOfFace) {
      cast_all(faces_[face], field, sensor, outcomes_of_face(met, face));
      continue;
    }
    some.driving_axis = faces_[face].driving_axis;
    some.direction = faces_[face].direction;
    some.group.assign(chosen.size(), 0);
    of_chosen.occupied = of_chosen.plane = of_chosen.unseen = {};
    cast_all(some, field, sensor, outcomes_of_face(of_chosen, 0));
    for (std::size_t i = 0; i < chosen.size(); ++i) {
      std::copy_n(&of_chosen.at[i * kPacketCells], kPacketCells, &met.at[chosen[i] * kPacketCells]);
      const auto put = [&](const Cells& from, Cells& to) {
        const std::uint64_t cells = from[i / kPacketsOfRow] >> first_of(i) & kPacket;
        to[chosen[i] / kPacketsOfRow] |= cells << first_of(chosen[i]);
      };
      put(of_chosen.occupied, met.occupied);
      put(of_chosen.plane, met.plane);
      put(of_chosen.unseen, met.unseen);
    }
  }
}

Panorama::Packets Panorama::all_packets() {
  Packets packets;
  packets.fill(~std::uint64_t{0});
  return packets;
}

Panorama::Packets Panorama::with_any(const Cells& cells) {
  Packets packets{};
  for (std::size_t i = 0; i < kPackets; ++i) {
    const bool any = (cells[i / kPacketsOfRow] >> first_of(i) & kPacket) != 0;
    packets[i / 64] |= std::uint64_t{any} << i % 64;
  }
  return packets;
}

Panorama::Packets Panorama::with_all(const Cells& cells) {
  Packets packets{};
  for (std::size_t i = 0; i < kPackets; ++i) {
    const bool all = (cells[i / kPacketsOfRow] >> first_of(i) & kPacket) == kPacket;
    packets[i / 64] |= std::uint64_t{all} << i % 64;
  }
  return packets;
}

void Panorama::add_all(const Packets& packets, Cells& cells) {
  for (std::size_t i = 0; i < kPackets; ++i) {
    if ((packets[i / 64] >> i % 64 & 1) != 0) cells[i / kPacketsOfRow] |= kPacket << first_of(i);
  }
}

// At step k a line's other coordinates are those of the ray, rounded. So it passes a voxel when its
// slopes, times k, are within half a voxel of it.
void Panorama::add_passing(const VoxelIndex& step, Packets& packets) {
  for (int axis = 0; axis < 3; ++axis) {
    const int k = std::abs(step[axis]);
    if (k == 0) continue;
    const auto cells_across = [&](int other) {
      return cells_between((step[other] - 0.5) / k, (step[other] + 0.5) / k);
    };
    const auto [first_column, last_column] = cells_across((axis + 1) % 3);
    const auto [first_row, last_row] = cells_across((axis + 2) % 3);
    const int face = 2 * axis + (step[axis] < 0 ? 1 : 0);
    for (int row = first_row; row <= last_row; ++row) {
      constexpr int kWide = static_cast<int>(kPacketCells);
      for (int part = first_column / kWide; part <= last_column / kWide; ++part) {
        if (first_column > last_column) break;
        const auto packet = static_cast<std::size_t>(face * kSide + row) * kPacketsOfRow +
                            static_cast<std::size_t>(part);
        packets[packet / 64] |= std::uint64_t{1} << packet % 64;
      }
    }
  }
}

PanoramaViews::PanoramaViews(const RayTable& rays, std::span<const Orientation> orientations) {
  const Aperture aperture(rays);
  std::vector<Eigen::Vector3d> directions;
  directions.reserve(Panorama::kCells);
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

}  // namespace nextview

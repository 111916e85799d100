#pragma once

#include <cstdint>
#include <ostream>
#include <span>
#include <string>
#include <vector>

namespace nextview {

/// The two formats of point files: PLY and PCL's PCD 0.7, both binary and little-endian. Points are
/// the same bytes in both, one after the other; only the headers differ.
enum class PointFormat { Ply, Pcd };

/// What a point carries: 32 bits each.
struct PointField {
  enum class Type { Float, Unsigned };
  std::string ply_name;
  std::string pcd_name;
  Type type = Type::Float;
};

/// x, y, z: metres, world frame. The first three fields of every point file of ours.
std::vector<PointField> position_fields();
/// The components of a unit vector, world frame: nx, ny, nz in PLY, normal_x, ... in PCD.
std::vector<PointField> normal_fields();

/// Writes the points of one file, whose number is known from the start.
class PointWriter {
 public:
  /// Writes the header. The stream must outlive the object.
  /// @param comment one line that says what the points are; it must not hold a newline
  PointWriter(std::ostream& out, PointFormat format, const std::vector<PointField>& fields,
              std::uint64_t points, const std::string& comment);

  PointWriter& operator<<(float value);
  PointWriter& operator<<(std::uint32_t value);

 private:
  std::ostream& out_;
};

}  // namespace nextview

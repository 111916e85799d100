#include "exporter/point_file.h"

#include <bit>

namespace nextview {
namespace {

void write_ply_header(std::ostream& out, const std::vector<PointField>& fields,
                      std::uint64_t points, const std::string& comment) {
  out << "ply\nformat binary_little_endian 1.0\ncomment " << comment << "\nelement vertex "
      << points << '\n';
  for (const PointField& field : fields) {
    out << "property " << (field.type == PointField::Type::Float ? "float " : "uint ")
        << field.ply_name << '\n';
  }
  out << "end_header\n";
}

void write_pcd_header(std::ostream& out, const std::vector<PointField>& fields,
                      std::uint64_t points, const std::string& comment) {
  std::string names, sizes, types, counts;
  for (const PointField& field : fields) {
    names += ' ' + field.pcd_name;
    sizes += " 4";
    types += field.type == PointField::Type::Float ? " F" : " U";
    counts += " 1";
  }
  out << "# .PCD v0.7 - Point Cloud Data file format\n# " << comment << "\nVERSION 0.7\nFIELDS"
      << names << "\nSIZE" << sizes << "\nTYPE" << types << "\nCOUNT" << counts << "\nWIDTH "
      << points << "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " << points << "\nDATA binary\n";
}

}  // namespace

std::vector<PointField> position_fields() { return {{"x", "x"}, {"y", "y"}, {"z", "z"}}; }

std::vector<PointField> normal_fields() {
  return {{"nx", "normal_x"}, {"ny", "normal_y"}, {"nz", "normal_z"}};
}

PointWriter::PointWriter(std::ostream& out, PointFormat format,
                         const std::vector<PointField>& fields, std::uint64_t points,
                         const std::string& comment)
    : out_(out) {
  switch (format) {
    case PointFormat::Ply:
      write_ply_header(out, fields, points, comment);
      break;
    case PointFormat::Pcd:
      write_pcd_header(out, fields, points, comment);
      break;
  }
}

PointWriter& PointWriter::operator<<(std::uint32_t value) {
  const char bytes[4] = {static_cast<char>(value), static_cast<char>(value >> 8),
                         static_cast<char>(value >> 16), static_cast<char>(value >> 24)};
  out_.write(bytes, sizeof bytes);
  return *this;
}

PointWriter& PointWriter::operator<<(float value) {
  return *this << std::bit_cast<std::uint32_t>(value);
}

}  // namespace nextview

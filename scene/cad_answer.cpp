#include "scene/cad_answer.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace nextview {
namespace {

using Tag = std::array<char, 8>;
constexpr Tag kMesh = {'m', 'e', 's', 'h', '\0', '\0', '\0', '1'};
constexpr Tag kWhyNot = {'w', 'h', 'y', 'n', 'o', 't', '\0', '1'};

/// What an answer begins with. The reader is of the same build, so both see the same bytes.
struct Heading {
  Tag tag;
  std::uint64_t vertices;   ///< or the characters of why there is no mesh
  std::uint64_t triangles;  ///< or 0
  std::array<double, 3> origin_in_file_m;
};

template <class Container>
bool write_all(std::FILE* file, const Container& container) {
  return std::fwrite(container.data(), sizeof(container[0]), container.size(), file) ==
         container.size();
}

template <class Container>
bool read_all(std::FILE* file, Container& container) {
  return std::fread(container.data(), sizeof(container[0]), container.size(), file) ==
         container.size();
}

bool write_heading(std::FILE* file, const Heading& heading) {
  return std::fwrite(&heading, sizeof heading, 1, file) == 1;
}

/// Bytes from the beginning of a file to its end.
std::uint64_t size_of(std::FILE* file) {
  if (std::fseek(file, 0, SEEK_END) != 0) return 0;
  const long size = std::ftell(file);
  return size < 0 ? 0 : static_cast<std::uint64_t>(size);
}

bool is_sound(const TriangleMesh& mesh) {
  return mesh.origin_in_file_m.allFinite() &&
         std::all_of(mesh.vertices_m.begin(), mesh.vertices_m.end(),
                     [](const Eigen::Vector3f& vertex_m) { return vertex_m.allFinite(); }) &&
         std::all_of(mesh.triangles.begin(), mesh.triangles.end(), [&mesh](const auto& triangle) {
           return *std::max_element(triangle.begin(), triangle.end()) < mesh.vertices_m.size();
         });
}

}  // namespace

bool write_answer(std::FILE* file, const TriangleMesh& mesh) {
  return write_heading(file, {kMesh,
                              mesh.vertices_m.size(),
                              mesh.triangles.size(),
                              {mesh.origin_in_file_m.x(), mesh.origin_in_file_m.y(),
                               mesh.origin_in_file_m.z()}}) &&
         write_all(file, mesh.vertices_m) && write_all(file, mesh.triangles) &&
         std::fflush(file) == 0;
}

bool write_answer(std::FILE* file, const std::string& why_not) {
  return write_heading(file, {kWhyNot, why_not.size(), 0, {}}) && write_all(file, why_not) &&
         std::fflush(file) == 0;
}

std::optional<CadAnswer> take_answer(std::FILE* file) {
  const std::uint64_t size = size_of(file);
  std::rewind(file);
  Heading heading{};
  if (std::fread(&heading, sizeof heading, 1, file) != 1) return std::nullopt;
  // Sizes are held against what is there before anything is allocated.
  if (heading.vertices > size || heading.triangles > size) return std::nullopt;
  CadAnswer answer;
  if (heading.tag == kWhyNot) {
    answer.why_not.resize(heading.vertices);
    if (!read_all(file, answer.why_not)) return std::nullopt;
    return answer;
  }
  TriangleMesh mesh;
  if (heading.tag != kMesh || size != sizeof heading +
                                          heading.vertices * sizeof(mesh.vertices_m[0]) +
                                          heading.triangles * sizeof(mesh.triangles[0])) {
    return std::nullopt;
  }
  mesh.origin_in_file_m = Eigen::Vector3d(heading.origin_in_file_m.data());
  mesh.vertices_m.resize(heading.vertices);
  mesh.triangles.resize(heading.triangles);
  if (!read_all(file, mesh.vertices_m) || !read_all(file, mesh.triangles) || !is_sound(mesh)) {
    return std::nullopt;
  }
  answer.mesh = std::move(mesh);
  return answer;
}

}  // namespace nextview

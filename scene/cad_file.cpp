#include "scene/cad_file.h"

#include <assimp/config.h>
#include <assimp/importerdesc.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <xxhash.h>

#include <assimp/Importer.hpp>
#include <bit>
#include <cmath>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "lcmtypes/parameter_bounds.h"
#include "scene/vertex_shift.h"

namespace nextview {
namespace {

// The shapes of a file's nodes: vertices in the world frame, metres, and three of them a triangle.
struct Shapes {
  std::vector<Eigen::Vector3f> vertices_m;
  std::vector<std::uint32_t> corners;
  Eigen::AlignedBox3d bounds_m;  // of what is finite
  double farthest_m = 0.0;       // of a coordinate from zero, in the world or in a node of the file
};

Eigen::Matrix4d matrix(const aiMatrix4x4& m) {
  Eigen::Matrix4d result;
  result << m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4, m.d1, m.d2,
      m.d3, m.d4;
  return result;
}

// The rotation from a file's axes to z up.
Eigen::Matrix4d z_up_from(UpAxis up) {
  Eigen::Matrix4d rotation = Eigen::Matrix4d::Identity();
  switch (up) {
    case UpAxis::X:
      rotation.topLeftCorner<3, 3>() << 0, -1, 0, 0, 0, -1, 1, 0, 0;
      break;
    case UpAxis::Y:
      rotation.topLeftCorner<3, 3>() << 1, 0, 0, 0, 0, -1, 0, 1, 0;
      break;
    case UpAxis::Z:
      break;
  }
  return rotation;
}

Eigen::Matrix4d scaling(double factor) {
  Eigen::Matrix4d scale = Eigen::Matrix4d::Identity();
  scale.diagonal().head<3>().setConstant(factor);
  return scale;
}

std::string reader_name(const Assimp::Importer& importer) {
  const int index = importer.GetPropertyInteger("importerIndex", -1);
  const aiImporterDesc* reader =
      index < 0 ? nullptr : importer.GetImporterInfo(static_cast<std::size_t>(index));
  return reader == nullptr ? std::string() : std::string(reader->mName);
}

// What takes the root node of the file as assimp returns it to the world frame.
//
// COLLADA: assimp multiplies the root node by <unit>, and turns it to y up unless told not to
// (AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, set when `up` is given). So the axis is either
// ours or the file's, never both, and a unit that is given first takes the file's out again; the
// root carries nothing else.
Eigen::Matrix4d world_from_root(const aiScene& scene, const std::string& reader,
                                const SceneOptions& options) {
  if (reader.starts_with("Collada")) {
    const double file_unit_m = matrix(scene.mRootNode->mTransformation).col(0).head<3>().norm();
    const double factor = options.unit_m ? *options.unit_m / file_unit_m : 1.0;
    return z_up_from(options.up.value_or(UpAxis::Y)) * scaling(factor);
  }
  if (reader.starts_with("Discreet 3DS")) {
    // z up by convention, and assimp turns it to y up, always.
    const Eigen::Matrix4d file_from_root = z_up_from(UpAxis::Y);
    return z_up_from(options.up.value_or(UpAxis::Z)) * file_from_root *
           scaling(options.unit_m.value_or(1.0));
  }
  const UpAxis up_of_format = reader.starts_with("glTF") ? UpAxis::Y : UpAxis::Z;
  return z_up_from(options.up.value_or(up_of_format)) * scaling(options.unit_m.value_or(1.0));
}

// Up to here floats, which is what Debian's assimp makes of every coordinate, tell millimetres
// apart.
constexpr double kFarthest_m = bounds::kWorkspace.most;

// To a hundredth of a millimetre, far below what a sensor measures: so the same room is the same to
// the last bit whatever format, unit, axis and nodes it has gone through.
Eigen::Vector3f rounded(const Eigen::Vector3d& vertex_m) {
  constexpr double kStepsPerMetre = 1e5;
  return ((kStepsPerMetre * vertex_m).array().round() / kStepsPerMetre).matrix().cast<float>();
}

void add_mesh(const aiMesh& mesh, const Eigen::Matrix4d& world_from_mesh,
              const std::filesystem::path& file, Shapes& shapes) {
  const auto first = static_cast<std::uint32_t>(shapes.vertices_m.size());
  const double scale = world_from_mesh.topLeftCorner<3, 3>().colwise().norm().maxCoeff();
  for (unsigned int i = 0; i < mesh.mNumVertices; ++i) {
    const aiVector3D& p = mesh.mVertices[i];
    const Eigen::Vector3d given(p.x, p.y, p.z);
    const Eigen::Vector4d vertex_m = world_from_mesh * given.homogeneous();
    if (vertex_m.allFinite()) {  // else it is said of the triangle
      shapes.bounds_m.extend(vertex_m.head<3>());
      shapes.farthest_m = std::max({shapes.farthest_m, scale * given.cwiseAbs().maxCoeff(),
                                    vertex_m.head<3>().cwiseAbs().maxCoeff()});
    }
    shapes.vertices_m.push_back(rounded(vertex_m.head<3>()));
  }
  for (unsigned int i = 0; i < mesh.mNumFaces; ++i) {
    const aiFace& face = mesh.mFaces[i];
    if (face.mNumIndices != 3) {
      continue;  // a point or a line
    }
    for (unsigned int k = 0; k < 3; ++k) {
      if (face.mIndices[k] >= mesh.mNumVertices) {
        throw SceneError(file.string() + ": a triangle names vertex " +
                         std::to_string(face.mIndices[k]) + " of " +
                         std::to_string(mesh.mNumVertices) + "; export the file again");
      }
      shapes.corners.push_back(first + face.mIndices[k]);
    }
  }
}

// Depth first in the file's order; a mesh that several nodes name appears once for each.
void add_node(const aiScene& scene, const aiNode& node, const Eigen::Matrix4d& world_from_parent,
              const std::filesystem::path& file, Shapes& shapes) {
  const Eigen::Matrix4d world_from_node = world_from_parent * matrix(node.mTransformation);
  for (unsigned int i = 0; i < node.mNumMeshes; ++i) {
    add_mesh(*scene.mMeshes[node.mMeshes[i]], world_from_node, file, shapes);
  }
  for (unsigned int i = 0; i < node.mNumChildren; ++i) {
    add_node(scene, *node.mChildren[i], world_from_node, file, shapes);
  }
}

struct BytesHash {
  template <class Array>
  std::size_t operator()(const Array& array) const {
    return XXH3_64bits(array.data(), sizeof(array));
  }
};

// Numbers equal vertices alike, in the order of their first appearance.
class VertexTable {
 public:
  explicit VertexTable(std::size_t expected) { numbers_.reserve(expected); }

  std::uint32_t number_of(const Eigen::Vector3f& vertex_m) {
    const Eigen::Vector3f v = vertex_m + Eigen::Vector3f::Zero();  // -0 becomes 0
    const std::array<std::uint32_t, 3> bits{std::bit_cast<std::uint32_t>(v.x()),
                                            std::bit_cast<std::uint32_t>(v.y()),
                                            std::bit_cast<std::uint32_t>(v.z())};
    const auto [entry, is_new] =
        numbers_.try_emplace(bits, static_cast<std::uint32_t>(vertices_m.size()));
    if (is_new) {
      vertices_m.push_back(v);
    }
    return entry->second;
  }

  std::vector<Eigen::Vector3f> vertices_m;

 private:
  std::unordered_map<std::array<std::uint32_t, 3>, std::uint32_t, BytesHash> numbers_;
};

// Flat to within what float coordinates can tell: lower than a ten-millionth of its longest side.
bool has_no_area(const Eigen::Vector3f& a, const Eigen::Vector3f& b, const Eigen::Vector3f& c) {
  const Eigen::Vector3d ab = (b.cast<double>() - a.cast<double>());
  const Eigen::Vector3d ac = (c.cast<double>() - a.cast<double>());
  const double longest_squared =
      std::max({ab.squaredNorm(), ac.squaredNorm(), (ac - ab).squaredNorm()});
  return ab.cross(ac).norm() <= 1e-7 * longest_squared;
}

TriangleMesh tidy_mesh(const Shapes& shapes, const std::filesystem::path& file) {
  constexpr std::uint32_t kNoNumber = 0xffffffff;
  VertexTable vertices(shapes.vertices_m.size());
  // Looked up once for each vertex of the file, of which most triangles share theirs.
  std::vector<std::uint32_t> number(shapes.vertices_m.size(), kNoNumber);
  std::unordered_set<std::array<std::uint32_t, 3>, BytesHash> seen;
  seen.reserve(shapes.corners.size() / 3);
  TriangleMesh mesh;
  for (std::size_t i = 0; i < shapes.corners.size(); i += 3) {
    const std::uint32_t* corner = &shapes.corners[i];
    const auto vertex = [&](std::size_t k) -> const Eigen::Vector3f& {
      return shapes.vertices_m[corner[k]];
    };
    if (!vertex(0).allFinite() || !vertex(1).allFinite() || !vertex(2).allFinite()) {
      throw SceneError(file.string() + ": triangle " + std::to_string(i / 3) +
                       " has a coordinate that is not finite; repair the file, or check the "
                       "unit if one was given");
    }
    if (has_no_area(vertex(0), vertex(1), vertex(2))) {
      continue;
    }
    std::array<std::uint32_t, 3> triangle;
    for (std::size_t k = 0; k < 3; ++k) {
      std::uint32_t& known = number[corner[k]];
      if (known == kNoNumber) known = vertices.number_of(vertex(k));
      triangle[k] = known;
    }
    std::array<std::uint32_t, 3> sorted = triangle;
    std::sort(sorted.begin(), sorted.end());
    if (seen.insert(sorted).second) {
      mesh.triangles.push_back(triangle);
    }
  }
  mesh.vertices_m = std::move(vertices.vertices_m);
  return mesh;
}

// A CAD file in the hands of assimp.
class CadFile {
 public:
  CadFile(std::filesystem::path file, const SceneOptions& options)
      : file_(std::move(file)), options_(options) {
    importer_.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, options.up.has_value());
    // Without this a file of bones alone would be given a body of assimp's own making.
    importer_.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
  }

  Shapes read() { return shapes_of(importer_.ReadFile(file_.string(), aiProcess_Triangulate)); }

  // Read again, with the world's origin elsewhere in the file's frame.
  Shapes read_around(const Eigen::Vector3d& origin_in_file_m, double farthest_m) {
    const std::string reader = reader_name(importer_);
    // These two have no nodes that are turned or scaled, so what is between file and world is
    // known.
    const Eigen::Vector3d shift =
        (z_up_from(options_.up.value_or(UpAxis::Z)).topLeftCorner<3, 3>()).transpose() *
        origin_in_file_m / options_.unit_m.value_or(1.0);
    std::optional<std::string> shifted;
    if (reader.starts_with("Wavefront")) shifted = shifted_obj(bytes(), shift);
    if (reader.starts_with("Stanford")) shifted = shifted_ply(bytes(), shift);
    if (!shifted) {
      throw SceneError(
          file_.string() + ": a vertex lies " + std::to_string(std::llround(farthest_m)) +
          " m from the origin, where floats, in which this file or assimp holds it, are no "
          "longer exact to a millimetre (" +
          std::to_string(std::llround(kFarthest_m)) +
          " m at most): export it as OBJ or PLY with all digits, which are read in double, move "
          "it to the origin in the program it comes from, or give the right --unit");
    }
    return shapes_of(importer_.ReadFileFromMemory(shifted->data(), shifted->size(),
                                                  aiProcess_Triangulate,
                                                  reader.starts_with("Stanford") ? "ply" : "obj"));
  }

 private:
  Shapes shapes_of(const aiScene* scene) const {
    if (scene == nullptr || scene->mRootNode == nullptr) {
      throw SceneError(file_.string() + ": cannot be read as a CAD file (" +
                       importer_.GetErrorString() +
                       "); convert it to a format assimp reads, for example OBJ, PLY, STL, COLLADA "
                       "or glTF");
    }
    Shapes shapes;
    add_node(*scene, *scene->mRootNode, world_from_root(*scene, reader_name(importer_), options_),
             file_, shapes);
    return shapes;
  }

  std::string bytes() const {
    std::ifstream stream(file_, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }

  std::filesystem::path file_;
  SceneOptions options_;
  Assimp::Importer importer_;
};

// Whole kilometres, so that what a user knows of the file's coordinates can still be recognised;
// along an axis that needs none, a height say, zero.
Eigen::Vector3d origin_for(const Eigen::AlignedBox3d& bounds_m) {
  Eigen::Vector3d origin_m = Eigen::Vector3d::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    const double farthest_m = std::max(-bounds_m.min()[axis], bounds_m.max()[axis]);
    if (farthest_m > kFarthest_m) origin_m[axis] = std::floor(bounds_m.min()[axis] / 1e3) * 1e3;
  }
  return origin_m;
}

}  // namespace

TriangleMesh read_cad_file(const std::filesystem::path& file, const SceneOptions& options) {
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) {
    throw SceneError(file.string() + ": no such file");
  }
  if (std::filesystem::is_directory(file, ignored)) {
    throw SceneError(file.string() + ": is a folder; name a CAD file in it");
  }

  CadFile cad_file(file, options);
  Shapes shapes = cad_file.read();
  Eigen::Vector3d origin_in_file_m = Eigen::Vector3d::Zero();
  if (shapes.farthest_m > kFarthest_m) {
    const double span_m = shapes.bounds_m.sizes().maxCoeff();
    if (span_m > kFarthest_m) {
      throw SceneError(file.string() + ": is " + std::to_string(std::llround(span_m)) +
                       " m long, where " + std::to_string(std::llround(kFarthest_m)) +
                       " m are the most: give the right --unit, or export a part of it");
    }
    origin_in_file_m = origin_for(shapes.bounds_m);
    shapes = cad_file.read_around(origin_in_file_m, shapes.farthest_m);
  }
  TriangleMesh mesh = tidy_mesh(shapes, file);
  mesh.origin_in_file_m = origin_in_file_m;
  if (mesh.triangles.empty()) {
    throw SceneError(file.string() +
                     ": has no triangles with an area; export the surfaces as polygons");
  }
  return mesh;
}

}  // namespace nextview

#include "exporter/recovered_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "exporter/marching_cubes.h"
#include "exporter/one_voxel_holes.h"

namespace nextview {
namespace {

/// What a voxel is to the mesh.
enum class Matter { Free, Seen, Unseen };

// Whether a voxel lies between two Empty ones along two axes at least: alone among them, or in a
// line.
bool is_crumb(const VoxelMap& map, const VoxelIndex& voxel) {
  int axes = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const VoxelIndex step = VoxelIndex::Unit(axis);
    axes += map.label(voxel + step) == Label::Empty && map.label(voxel - step) == Label::Empty;
  }
  return axes >= 2;
}

Matter matter_of(const VoxelMap& map, const VoxelIndex& voxel) {
  switch (map.label(voxel)) {
    case Label::Occupied:
      return Matter::Seen;
    case Label::Empty:
      return is_one_voxel_hole(map, voxel) ? Matter::Seen : Matter::Free;
    case Label::Unmarked:
    case Label::Occluded:
    case Label::OcclusionPlane:
      return is_crumb(map, voxel) ? Matter::Free : Matter::Unseen;
  }
  return Matter::Unseen;
}

VoxelIndex corner_of_cube(int corner) { return {corner & 1, corner >> 1 & 1, corner >> 2 & 1}; }

// The cubes of eight voxel centres of which one is Occupied, by their first corner, in order.
std::vector<VoxelIndex> cubes_at_surface(const VoxelMap& map) {
  std::vector<VoxelIndex> cubes;
  for_each_voxel(map.window(), [&](const VoxelIndex& voxel) {
    if (map.label(voxel) != Label::Occupied) return;
    for (int corner = 0; corner < 8; ++corner) cubes.push_back(voxel - corner_of_cube(corner));
  });
  const auto order = [](const VoxelIndex& v) { return std::tuple(v[2], v[1], v[0]); };
  std::sort(cubes.begin(), cubes.end(),
            [&](const VoxelIndex& a, const VoxelIndex& b) { return order(a) < order(b); });
  cubes.erase(std::unique(cubes.begin(), cubes.end()), cubes.end());
  return cubes;
}

// A vertex half way between a free and a solid voxel.
struct Crossing {
  VoxelIndex solid;
  Eigen::Vector3d midpoint_m;
};

class Builder {
 public:
  Builder(const VoxelMap& map, const OrientedPoints& points) : map_(map), points_(points) {}

  SurfaceMesh build() {
    for (const VoxelIndex& cube : cubes_at_surface(map_)) add_cube(cube);
    place_vertices();
    return std::move(mesh_);
  }

 private:
  void add_cube(const VoxelIndex& cube);
  std::uint32_t vertex_on(const VoxelIndex& cube, int edge, const std::array<Matter, 8>& matter);
  void place_vertices();
  std::vector<Eigen::Vector3d> outward_normals() const;
  Eigen::Vector3d on_sensed_surface(const Crossing& crossing, const Eigen::Vector3d& outward) const;
  void move_vertex(std::size_t vertex);
  bool is_spoilt(std::size_t triangle) const;

  const VoxelMap& map_;
  const OrientedPoints& points_;
  SurfaceMesh mesh_;
  std::vector<Crossing> crossings_;                       // of the vertices
  std::vector<Eigen::Vector3d> moves_;                    // of the vertices, from their midpoints
  std::vector<Eigen::Vector3d> unmoved_;                  // area vectors of the triangles
  std::map<std::array<int, 4>, std::uint32_t> vertices_;  // by the edge's first voxel and axis
};

void Builder::add_cube(const VoxelIndex& cube) {
  std::array<Matter, 8> matter;
  unsigned solid = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Matter at = matter_of(map_, cube + corner_of_cube(corner));
    matter[static_cast<std::size_t>(corner)] = at;
    solid |= (at == Matter::Free ? 0U : 1U) << corner;
  }
  for (const std::array<int, 3>& edges : cube_triangles(solid)) {
    // A triangle is seen when one of its corners is: so the mesh reaches beyond every Occupied
    // voxel, and two triangles share an edge wherever one of its ends is seen.
    const bool seen = std::any_of(edges.begin(), edges.end(), [&](int edge) {
      const CubeEdge at = cube_edge(edge);
      return matter[static_cast<std::size_t>(at.corner)] == Matter::Seen ||
             matter[static_cast<std::size_t>(at.corner | 1 << at.axis)] == Matter::Seen;
    });
    if (!seen) continue;
    mesh_.triangles.push_back({vertex_on(cube, edges[0], matter), vertex_on(cube, edges[1], matter),
                               vertex_on(cube, edges[2], matter)});
  }
}

std::uint32_t Builder::vertex_on(const VoxelIndex& cube, int edge,
                                 const std::array<Matter, 8>& matter) {
  const CubeEdge at = cube_edge(edge);
  const VoxelIndex first = cube + corner_of_cube(at.corner);
  const auto [entry, is_new] = vertices_.try_emplace({first[2], first[1], first[0], at.axis},
                                                     static_cast<std::uint32_t>(crossings_.size()));
  if (is_new) {
    const VoxelIndex second = first + VoxelIndex::Unit(at.axis);
    const bool first_is_free = matter[static_cast<std::size_t>(at.corner)] == Matter::Free;
    crossings_.push_back({first_is_free ? second : first,
                          0.5 * (map_.grid().center_m(first) + map_.grid().center_m(second))});
  }
  return entry->second;
}

std::vector<Eigen::Vector3d> Builder::outward_normals() const {
  std::vector<Eigen::Vector3d> normals(crossings_.size(), Eigen::Vector3d::Zero());
  for (std::size_t i = 0; i < mesh_.triangles.size(); ++i) {
    for (const std::uint32_t vertex : mesh_.triangles[i]) normals[vertex] += unmoved_[i];
  }
  for (Eigen::Vector3d& normal : normals) normal.normalize();
  return normals;
}

// Moves a point onto the sensed surface that shows the same side: twice onto the plane through the
// weighted mean of the points nearby, along the weighted mean of their normals.
Eigen::Vector3d Builder::on_sensed_surface(const Crossing& crossing,
                                           const Eigen::Vector3d& outward) const {
  constexpr double kSameSide = 0.25;    // cosine between normals
  constexpr double kReachVoxels = 0.6;  // standard deviation of the weights
  constexpr double kFarthestVoxels = 1.5;
  const double size_m = map_.grid().voxel_size_m;
  const double reach_m = kReachVoxels * size_m;
  Eigen::Vector3d at = crossing.midpoint_m;
  for (int step = 0; step < 2; ++step) {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    double weights = 0.0;
    for_each_voxel(
        {crossing.solid - VoxelIndex(1, 1, 1), VoxelIndex(3, 3, 3)}, [&](const VoxelIndex& voxel) {
          const OrientedPoints::Planes* planes = points_.at(voxel);
          if (planes == nullptr) return;
          for (const OrientedPoints::Plane& plane : *planes) {
            if (plane.points == 0.0) continue;
            const Eigen::Vector3d plane_normal = plane.normal();
            if (plane_normal.dot(outward) < kSameSide) continue;
            const double distance_m = (plane.position_m() - at).norm() / reach_m;
            const double weight =
                std::exp(-0.5 * distance_m * distance_m) * plane.points / (plane.points + 1.0);
            mean += weight * plane.position_m();
            normal += weight * plane_normal;
            weights += weight;
          }
        });
    if (weights < 1e-6) return at;
    normal.normalize();
    at -= normal * normal.dot(at - mean / weights);
  }
  const Eigen::Vector3d move = at - crossing.midpoint_m;
  const double farthest_m = kFarthestVoxels * size_m;
  return move.norm() <= farthest_m
             ? at
             : Eigen::Vector3d(crossing.midpoint_m + move * (farthest_m / move.norm()));
}

void Builder::move_vertex(std::size_t vertex) {
  mesh_.vertices_m[vertex] = (crossings_[vertex].midpoint_m + moves_[vertex]).cast<float>();
}

// Nearly flat, or turned over.
bool Builder::is_spoilt(std::size_t triangle) const {
  constexpr double kLowestVoxels = 0.01;
  return least_height_m(mesh_, mesh_.triangles[triangle]) <
             kLowestVoxels * map_.grid().voxel_size_m ||
         area_vector_m2(mesh_, mesh_.triangles[triangle]).dot(unmoved_[triangle]) <= 0.0;
}

void Builder::place_vertices() {
  mesh_.vertices_m.resize(crossings_.size());
  moves_.assign(crossings_.size(), Eigen::Vector3d::Zero());
  for (std::size_t i = 0; i < crossings_.size(); ++i) move_vertex(i);
  for (const auto& triangle : mesh_.triangles) unmoved_.push_back(area_vector_m2(mesh_, triangle));
  const std::vector<Eigen::Vector3d> outward = outward_normals();
  for (std::size_t i = 0; i < crossings_.size(); ++i) {
    moves_[i] = on_sensed_surface(crossings_[i], outward[i]) - crossings_[i].midpoint_m;
    move_vertex(i);
  }
  // Unmoved, no triangle is spoilt: so this comes to an end.
  constexpr int kHalvings = 6;
  for (int round = 0;; ++round) {
    std::vector<std::uint32_t> too_far;
    for (std::size_t i = 0; i < mesh_.triangles.size(); ++i) {
      if (is_spoilt(i)) {
        too_far.insert(too_far.end(), mesh_.triangles[i].begin(), mesh_.triangles[i].end());
      }
    }
    if (too_far.empty()) return;
    std::sort(too_far.begin(), too_far.end());
    too_far.erase(std::unique(too_far.begin(), too_far.end()), too_far.end());
    for (const std::uint32_t vertex : too_far) {
      moves_[vertex] *= round < kHalvings ? 0.5 : 0.0;
      move_vertex(vertex);
    }
  }
}

}  // namespace

SurfaceMesh recovered_mesh(const VoxelMap& map, const OrientedPoints& points) {
  return Builder(map, points).build();
}

}  // namespace nextview

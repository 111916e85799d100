#include "scoring/surface_shadow.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <tuple>

namespace nextview {
namespace {

/// A shadow that takes more triangles is cheaper shown in parts, for smaller boxes.
constexpr std::size_t kMostTriangles = 200;

/// Numbers under which vertices with the same coordinates are the same.
std::vector<std::uint32_t> merged_vertices(const TriangleMesh& mesh) {
  const auto coordinates = [&](std::uint32_t i) {
    const Eigen::Vector3f& vertex = mesh.vertices_m[i];
    return std::tuple(vertex.x(), vertex.y(), vertex.z());
  };
  std::vector<std::uint32_t> order(mesh.vertices_m.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return coordinates(a) < coordinates(b); });
  std::vector<std::uint32_t> merged(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool repeated = i > 0 && coordinates(order[i]) == coordinates(order[i - 1]);
    merged[order[i]] = repeated ? merged[order[i - 1]] : order[i];
  }
  return merged;
}

}  // namespace

TriangleNeighbours::TriangleNeighbours(const TriangleMesh& mesh, const std::stop_token& stop)
    : mesh_(&mesh) {
  struct Edge {
    std::uint32_t low;
    std::uint32_t high;
    std::uint32_t of_triangle;  // 3 triangle + edge
  };
  const std::vector<std::uint32_t> merged = merged_vertices(mesh);
  if (stop.stop_requested()) return;
  std::vector<Edge> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t a = merged[mesh.triangles[t][k]];
      const std::uint32_t b = merged[mesh.triangles[t][(k + 1) % 3]];
      edges.push_back({std::min(a, b), std::max(a, b), 3 * t + k});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    return std::tie(a.low, a.high, a.of_triangle) < std::tie(b.low, b.high, b.of_triangle);
  });
  if (stop.stop_requested()) return;
  run_of_edge_.resize(edges.size());
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (i == 0 || edges[i].low != edges[i - 1].low || edges[i].high != edges[i - 1].high) {
      run_start_.push_back(static_cast<std::uint32_t>(i));
    }
    const std::uint32_t triangle = edges[i].of_triangle / 3;
    at_edges_.push_back({triangle, mesh.triangles[triangle][(edges[i].of_triangle + 2) % 3]});
    run_of_edge_[edges[i].of_triangle] = static_cast<std::uint32_t>(run_start_.size()) - 1;
  }
  run_start_.push_back(static_cast<std::uint32_t>(edges.size()));
}

SurfaceShadow::SurfaceShadow(const TriangleNeighbours& neighbours)
    : neighbours_(&neighbours), grown_in_(neighbours.mesh().triangles.size(), 0) {}

bool SurfaceShadow::covers(std::uint32_t triangle, const Eigen::Vector3d& point_m,
                           const Eigen::Vector3d& target_m) const {
  const TriangleMesh& mesh = neighbours_->mesh();
  const Eigen::Vector3d a = mesh.corner_m(triangle, 0) - point_m;
  const Eigen::Vector3d b = mesh.corner_m(triangle, 1) - point_m;
  const Eigen::Vector3d c = mesh.corner_m(triangle, 2) - point_m;
  const Eigen::Vector3d target = target_m - point_m;
  const Eigen::Vector3d normal = a.cross(b);
  const double side = normal.dot(c) < 0.0 ? -1.0 : 1.0;
  return side * normal.dot(target) > 0.0 && side * b.cross(c).dot(target) > 0.0 &&
         side * c.cross(a).dot(target) > 0.0;
}

bool SurfaceShadow::hides(std::uint32_t triangle, const Eigen::Vector3d& point_m,
                          const Eigen::Vector3d& target_m, const Eigen::AlignedBox3d& box) {
  if (!covers(triangle, point_m, target_m)) return false;
  const BoxPyramid pyramid(point_m, box);
  if (!pyramid.exists()) return false;
  ++call_;
  grown_.assign(1, triangle);
  grown_in_[triangle] = call_;
  for (std::size_t i = 0; i < grown_.size(); ++i) {
    if (grown_.size() > kMostTriangles || !grow_over(grown_[i], pyramid)) return false;
  }
  return true;
}

/// Adds what the pyramid meets next to a triangle; false where it meets a border of the shadow.
bool SurfaceShadow::grow_over(std::uint32_t triangle, const BoxPyramid& pyramid) {
  const TriangleMesh& mesh = neighbours_->mesh();
  const auto corners = pyramid.corners(mesh, triangle);
  if (!pyramid.is_behind(corners)) return false;
  for (std::size_t edge = 0; edge < 3; ++edge) {
    const BoxPyramid::Corner& from = corners[edge];
    const BoxPyramid::Corner& to = corners[(edge + 1) % 3];
    if ((from.outside & to.outside) != 0) continue;
    const Eigen::Vector3d normal = from.at.cross(to.at);
    if (pyramid.is_beside(normal)) continue;
    const bool this_side = normal.dot(corners[(edge + 2) % 3].at) > 0.0;
    const bool grown = neighbours_->any_at_edge(triangle, edge, [&](const auto& neighbour) {
      if (neighbour.triangle == triangle) return false;
      const Eigen::Vector3d at =
          mesh.vertices_m[neighbour.opposite].template cast<double>() - pyramid.point();
      const double side = normal.dot(at);
      if (this_side ? side >= 0.0 : side <= 0.0) return false;
      if (grown_in_[neighbour.triangle] != call_) {
        grown_in_[neighbour.triangle] = call_;
        grown_.push_back(neighbour.triangle);
      }
      return true;
    });
    if (!grown) return false;
  }
  return true;
}

}  // namespace nextview

#include "exporter/mesh_simplifier.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>
#include <utility>
#include <vector>

namespace nextview {
namespace {

constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();

// The mesh that the corners name, three a triangle, without the vertices they do not.
SurfaceMesh used_part(const SurfaceMesh& mesh, const std::vector<std::uint32_t>& corners) {
  SurfaceMesh result;
  std::vector<std::uint32_t> number(mesh.vertices_m.size(), kUnused);
  for (std::size_t i = 0; i < corners.size(); i += 3) {
    std::array<std::uint32_t, 3> triangle;
    for (std::size_t k = 0; k < 3; ++k) {
      std::uint32_t& known = number[corners[i + k]];
      if (known == kUnused) {
        known = static_cast<std::uint32_t>(result.vertices_m.size());
        result.vertices_m.push_back(mesh.vertices_m[corners[i + k]]);
      }
      triangle[k] = known;
    }
    result.triangles.push_back(triangle);
  }
  return result;
}

SurfaceMesh used_part(const SurfaceMesh& mesh) {
  const std::uint32_t* corners = mesh.triangles.empty() ? nullptr : mesh.triangles.front().data();
  return used_part(mesh, {corners, corners + 3 * mesh.triangles.size()});
}

// What meshoptimizer makes of a mesh.
SurfaceMesh collapsed(const SurfaceMesh& mesh, std::size_t triangles, double error_m) {
  const auto* corners = mesh.triangles.front().data();
  const std::size_t count = 3 * mesh.triangles.size();
  const float* positions = mesh.vertices_m.front().data();
  const std::size_t vertices = mesh.vertices_m.size();
  constexpr std::size_t kStride = sizeof(Eigen::Vector3f);
  // Its errors are shares of the mesh's extent.
  const double error = error_m / meshopt_simplifyScale(positions, vertices, kStride);
  std::vector<std::uint32_t> result(count);
  result.resize(meshopt_simplify(result.data(), corners, count, positions, vertices, kStride,
                                 3 * triangles, static_cast<float>(error), 0, nullptr));
  return used_part(mesh, result);
}

// Puts right what a collapse may leave behind.
class Repair {
 public:
  explicit Repair(SurfaceMesh& mesh) : mesh_(mesh) {}

  // Whether the mesh is sound in the end.
  bool run() {
    constexpr int kRounds = 8;
    for (int round = 0; round < kRounds; ++round) {
      if (!index_edges()) {
        if (!remove_back_to_back()) return false;
        continue;
      }
      if (!give_away_low_triangles()) return true;
    }
    return false;
  }

 private:
  using Edge = std::pair<std::uint32_t, std::uint32_t>;

  // Which triangle runs along an edge; false when two do in the same direction.
  bool index_edges() {
    triangle_at_.clear();
    for (std::size_t i = 0; i < mesh_.triangles.size(); ++i) {
      const auto& t = mesh_.triangles[i];
      for (std::size_t k = 0; k < 3; ++k) {
        if (!triangle_at_.emplace(Edge(t[k], t[(k + 1) % 3]), i).second) return false;
      }
    }
    return true;
  }

  // Two triangles of the same corners and opposite ways; their other neighbours fit each other.
  bool remove_back_to_back() {
    std::map<std::array<std::uint32_t, 3>, std::size_t> by_corners;
    std::vector<bool> out(mesh_.triangles.size(), false);
    bool any = false;
    for (std::size_t i = 0; i < mesh_.triangles.size(); ++i) {
      auto sorted = mesh_.triangles[i];
      std::sort(sorted.begin(), sorted.end());
      const auto [other, is_new] = by_corners.emplace(sorted, i);
      if (is_new) continue;
      any = out[i] = out[other->second] = true;
      by_corners.erase(other);
    }
    std::size_t kept = 0;
    for (std::size_t i = 0; i < out.size(); ++i) {
      if (!out[i]) mesh_.triangles[kept++] = mesh_.triangles[i];
    }
    mesh_.triangles.resize(kept);
    return any;
  }

  // A low triangle (a, b, c) whose longest side is c - a lies along its neighbour (a, c, d): the
  // two become (a, b, d) and (b, c, d). At an end of the surface there is no neighbour and nothing
  // lost.
  bool give_away_low_triangles() {
    std::vector<bool> out(mesh_.triangles.size(), false);
    bool any = false;
    for (std::size_t i = 0; i < mesh_.triangles.size(); ++i) {
      if (out[i] || least_height_m(mesh_, mesh_.triangles[i]) >= kLowest_m) continue;
      any = true;
      const auto [a, b, c] = from_longest_side(mesh_.triangles[i]);
      const auto neighbour = triangle_at_.find(Edge(a, c));
      if (neighbour == triangle_at_.end()) {
        out[i] = true;
        continue;
      }
      const std::size_t j = neighbour->second;
      std::uint32_t d = a;
      for (const std::uint32_t corner : mesh_.triangles[j]) {
        if (corner != a && corner != c) d = corner;
      }
      if (d == b || triangle_at_.contains(Edge(b, d)) || triangle_at_.contains(Edge(d, b)))
        continue;
      mesh_.triangles[i] = {a, b, d};
      mesh_.triangles[j] = {b, c, d};
      if (!index_edges()) return true;
    }
    std::size_t kept = 0;
    for (std::size_t i = 0; i < out.size(); ++i) {
      if (!out[i]) mesh_.triangles[kept++] = mesh_.triangles[i];
    }
    mesh_.triangles.resize(kept);
    return any;
  }

  // The corners so that the longest side runs from the last to the first.
  std::array<std::uint32_t, 3> from_longest_side(const std::array<std::uint32_t, 3>& t) const {
    const auto side_m = [&](std::size_t k) {
      return (mesh_.vertices_m[t[k]] - mesh_.vertices_m[t[(k + 1) % 3]]).norm();
    };
    std::size_t longest = 0;
    for (std::size_t k = 1; k < 3; ++k) {
      if (side_m(k) > side_m(longest)) longest = k;
    }
    return {t[(longest + 1) % 3], t[(longest + 2) % 3], t[longest]};
  }

  static constexpr double kLowest_m = 1e-6;
  SurfaceMesh& mesh_;
  std::map<Edge, std::size_t> triangle_at_;
};

}  // namespace

SurfaceMesh simplified(const SurfaceMesh& mesh, const SimplifyOptions& options) {
  if (options.error_m && !(std::isfinite(*options.error_m) && *options.error_m >= 0.0)) {
    throw std::invalid_argument("the error of a simplified mesh must be a length of 0 m or more");
  }
  if (mesh.triangles.empty() || (!options.triangles && !options.error_m)) return mesh;
  std::size_t triangles = options.triangles.value_or(0);
  double error_m = options.error_m.value_or(std::numeric_limits<float>::max());
  constexpr double kLess = 0.7;
  for (int attempt = 0; attempt < 16; ++attempt) {
    SurfaceMesh result = collapsed(mesh, triangles, error_m);
    if (Repair(result).run()) return used_part(result);
    triangles = std::max(result.triangles.size(), triangles);
    triangles += triangles / 3;
    error_m *= kLess;
  }
  return mesh;
}

}  // namespace nextview

#include "scene/triangle_distance.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace nextview {
namespace {

double clamp01(double value) { return std::clamp(value, 0.0, 1.0); }

// Squared distance of the segments p + s u and q + t v, s and t in [0, 1] (Ericson, "Real-Time
// Collision Detection", 5.1.9).
double squared_distance(const Eigen::Vector3d& p, const Eigen::Vector3d& u,
                        const Eigen::Vector3d& q, const Eigen::Vector3d& v) {
  const Eigen::Vector3d r = p - q;
  const double uu = u.dot(u);
  const double vv = v.dot(v);
  const double vr = v.dot(r);
  if (uu == 0.0) {
    const double t = vv > 0.0 ? clamp01(vr / vv) : 0.0;
    return (r - t * v).squaredNorm();
  }
  const double ur = u.dot(r);
  if (vv == 0.0) {
    return (r + clamp01(-ur / uu) * u).squaredNorm();
  }
  const double uv = u.dot(v);
  const double determinant = uu * vv - uv * uv;
  double s = determinant > 0.0 ? clamp01((uv * vr - ur * vv) / determinant) : 0.0;
  double t = (uv * s + vr) / vv;
  if (t < 0.0 || t > 1.0) {
    t = clamp01(t);
    s = clamp01((uv * t - ur) / uu);
  }
  return (r + s * u - t * v).squaredNorm();
}

// Whether the segment crosses the inside of the triangle; touching its edge is left to the edges.
bool crosses(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Triangle& triangle) {
  const Eigen::Vector3d direction = b - a;
  const Eigen::Vector3d edge1 = triangle[1] - triangle[0];
  const Eigen::Vector3d edge2 = triangle[2] - triangle[0];
  const Eigen::Vector3d p = direction.cross(edge2);
  const double determinant = edge1.dot(p);
  if (determinant == 0.0) {
    return false;
  }
  const Eigen::Vector3d s = a - triangle[0];
  const double u = s.dot(p) / determinant;
  const Eigen::Vector3d q = s.cross(edge1);
  const double v = direction.dot(q) / determinant;
  const double t = edge2.dot(q) / determinant;
  return u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t >= 0.0 && t <= 1.0;
}

}  // namespace

// By the region of the triangle's plane the point lies over (Ericson, 5.1.5).
Eigen::Vector3d nearest_point(const Triangle& triangle, const Eigen::Vector3d& p) {
  const auto& [a, b, c] = triangle;
  const Eigen::Vector3d ab = b - a;
  const Eigen::Vector3d ac = c - a;
  const double d1 = ab.dot(p - a);
  const double d2 = ac.dot(p - a);
  if (d1 <= 0.0 && d2 <= 0.0) return a;
  const double d3 = ab.dot(p - b);
  const double d4 = ac.dot(p - b);
  if (d3 >= 0.0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return a + d1 / (d1 - d3) * ab;
  const double d5 = ab.dot(p - c);
  const double d6 = ac.dot(p - c);
  if (d6 >= 0.0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return a + d2 / (d2 - d6) * ac;
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0.0 && d4 >= d3 && d5 >= d6) {
    return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
  }
  const double sum = va + vb + vc;
  return a + vb / sum * ab + vc / sum * ac;
}

// Unless they cross, the nearest pair is an end of the segment and the triangle, or the segment and
// an edge.
double segment_triangle_distance(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                 const Triangle& triangle) {
  if (crosses(a, b, triangle)) {
    return 0.0;
  }
  double squared = std::min((nearest_point(triangle, a) - a).squaredNorm(),
                            (nearest_point(triangle, b) - b).squaredNorm());
  for (std::size_t i = 0; i < 3; ++i) {
    squared = std::min(
        squared, squared_distance(a, b - a, triangle[i], triangle[(i + 1) % 3] - triangle[i]));
  }
  return std::sqrt(squared);
}

}  // namespace nextview

#include "planner/prediction/orientations.h"

#include <Eigen/Geometry>
#include <numbers>
#include <stdexcept>

#include "sensor/elementary_functions.h"

namespace nextview {

namespace {

std::vector<Eigen::Vector3d> icosahedron_vertices() {
  std::vector<Eigen::Vector3d> vertices;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double one : {-1.0, 1.0}) {
      for (const double phi : {-std::numbers::phi, std::numbers::phi}) {
        Eigen::Vector3d vertex = Eigen::Vector3d::Zero();
        vertex[(axis + 1) % 3] = one;
        vertex[(axis + 2) % 3] = phi;
        vertices.push_back(vertex.normalized());
      }
    }
  }
  return vertices;
}

// Neighbouring vertices of a unit icosahedron have the scalar product 1/sqrt(5); all others
// -1/sqrt(5) or -1.
bool are_neighbours(const Eigen::Vector3d& a, const Eigen::Vector3d& b) { return a.dot(b) > 0.0; }

std::vector<SphereTriangle> twenty_faces() {
  const std::vector<Eigen::Vector3d> vertices = icosahedron_vertices();
  std::vector<SphereTriangle> faces;
  for (std::size_t a = 0; a < vertices.size(); ++a) {
    for (std::size_t b = a + 1; b < vertices.size(); ++b) {
      if (!are_neighbours(vertices[a], vertices[b])) continue;
      for (std::size_t c = b + 1; c < vertices.size(); ++c) {
        if (are_neighbours(vertices[a], vertices[c]) && are_neighbours(vertices[b], vertices[c])) {
          faces.push_back({vertices[a], vertices[b], vertices[c]});
        }
      }
    }
  }
  return faces;
}

Eigen::Vector3d middle(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return (a + b).normalized();
}

std::vector<SphereTriangle> divided_into_four(const std::vector<SphereTriangle>& faces) {
  std::vector<SphereTriangle> parts;
  for (const auto& [a, b, c] : faces) {
    const Eigen::Vector3d ab = middle(a, b);
    const Eigen::Vector3d bc = middle(b, c);
    const Eigen::Vector3d ca = middle(c, a);
    parts.push_back({a, ab, ca});
    parts.push_back({b, bc, ab});
    parts.push_back({c, ca, bc});
    parts.push_back({ab, bc, ca});
  }
  return parts;
}

}  // namespace

std::vector<SphereTriangle> icosahedron_faces(int subdivisions) {
  if (subdivisions < 0 || subdivisions > 6) {
    throw std::invalid_argument("icosahedron faces can be subdivided 0 to 6 times");
  }
  std::vector<SphereTriangle> faces = twenty_faces();
  for (int i = 0; i < subdivisions; ++i) faces = divided_into_four(faces);
  return faces;
}

std::vector<Orientation> icosahedron_orientations(int subdivisions) {
  std::vector<Orientation> orientations;
  for (const auto& [a, b, c] : icosahedron_faces(subdivisions)) {
    Orientation orientation;
    orientation.direction = (a + b + c).normalized();
    orientation.pan_rad = elementary::atan2(-orientation.direction.x(), orientation.direction.y());
    orientation.tilt_rad = elementary::asin(orientation.direction.z());
    orientations.push_back(orientation);
  }
  return orientations;
}

Eigen::Vector3d random_direction_in(const SphereTriangle& face, RandomStream& random) {
  double along_b = random.uniform();
  double along_c = random.uniform();
  if (along_b + along_c > 1.0) {  // the other half of the parallelogram, folded back
    along_b = 1.0 - along_b;
    along_c = 1.0 - along_c;
  }
  const auto& [a, b, c] = face;
  return (a + along_b * (b - a) + along_c * (c - a)).normalized();
}

}  // namespace nextview

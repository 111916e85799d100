#include "scene/scene.h"

#include <embree3/rtcore.h>
#ifdef __x86_64__
#include <pmmintrin.h>
#include <xmmintrin.h>
#endif

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "scene/triangle_distance.h"

namespace nextview {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

// Embree asks for denormals off while it works on x86; the caller's arithmetic is left as it was.
class DenormalsOff {
 public:
#ifdef __x86_64__
  DenormalsOff() : saved_(_mm_getcsr()) {
    _mm_setcsr(saved_ | _MM_FLUSH_ZERO_ON | _MM_DENORMALS_ZERO_ON);
  }
  ~DenormalsOff() { _mm_setcsr(saved_); }
#else
  DenormalsOff() {}
  ~DenormalsOff() {}
#endif
  DenormalsOff(const DenormalsOff&) = delete;
  DenormalsOff& operator=(const DenormalsOff&) = delete;

#ifdef __x86_64__
 private:
  unsigned int saved_;
#endif
};

void check(const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) {
    throw std::invalid_argument("a scene needs at least one triangle");
  }
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t vertex : triangle) {
      if (vertex >= mesh.vertices_m.size()) {
        throw std::invalid_argument("a triangle of the scene names a vertex that is not there");
      }
    }
  }
  for (const Eigen::Vector3f& vertex : mesh.vertices_m) {
    if (!vertex.allFinite()) {
      throw std::invalid_argument("a vertex of the scene is not finite");
    }
  }
}

RTCRay ray_along(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction, float far) {
  RTCRay ray{};
  ray.org_x = origin.x();
  ray.org_y = origin.y();
  ray.org_z = origin.z();
  ray.dir_x = direction.x();
  ray.dir_y = direction.y();
  ray.dir_z = direction.z();
  ray.tfar = far;
  ray.mask = ~0U;
  return ray;
}

// A nearest-triangle search under way.
struct NearestTriangle {
  const TriangleMesh* mesh;
  Eigen::Vector3d a;
  Eigen::Vector3d b;
  double half_length;
  double distance;
};

// Embree looks for boxes within a sphere, in float: the sphere about the segment's middle that
// holds all within `distance` of the segment, and a little more.
float search_radius(const NearestTriangle& search, const Eigen::Vector3d& middle) {
  const double slack = 1e-5 * (1.0 + middle.cwiseAbs().maxCoeff());
  return static_cast<float>((search.half_length + search.distance) * (1.0 + 1e-6) + slack);
}

bool visit_triangle(RTCPointQueryFunctionArguments* arguments) {
  auto& search = *static_cast<NearestTriangle*>(arguments->userPtr);
  const std::size_t i = arguments->primID;
  const double distance = segment_triangle_distance(
      search.a, search.b,
      {search.mesh->corner_m(i, 0), search.mesh->corner_m(i, 1), search.mesh->corner_m(i, 2)});
  if (distance >= search.distance) {
    return false;
  }
  search.distance = distance;
  arguments->query->radius = search_radius(search, 0.5 * (search.a + search.b));
  return true;
}

}  // namespace

struct Scene::Embree {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;

  Embree() = default;
  Embree(const Embree&) = delete;
  Embree& operator=(const Embree&) = delete;
  ~Embree() {
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }
};

Scene::Scene(TriangleMesh mesh) : mesh_(std::move(mesh)), embree_(std::make_unique<Embree>()) {
  check(mesh_);
  // One thread: the tree, and with it which of two equally near triangles is met, comes out the
  // same every time.
  embree_->device = rtcNewDevice("threads=1,set_affinity=0");
  if (embree_->device == nullptr) {
    throw std::runtime_error("Embree does not start: error " +
                             std::to_string(rtcGetDeviceError(nullptr)));
  }
  embree_->scene = rtcNewScene(embree_->device);
  // Robust: no ray slips through the edge two triangles share, so that a closed room stays closed.
  rtcSetSceneFlags(embree_->scene, RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(embree_->scene, RTC_BUILD_QUALITY_MEDIUM);

  RTCGeometry geometry = rtcNewGeometry(embree_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
  // Embree's own copy, because it reads a little beyond the end of a vertex buffer.
  auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                                               RTC_FORMAT_FLOAT3, 3 * sizeof(float),
                                                               mesh_.vertices_m.size()));
  auto* indices = static_cast<std::uint32_t*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                              3 * sizeof(std::uint32_t), mesh_.triangles.size()));
  if (vertices == nullptr || indices == nullptr) {
    throw std::runtime_error("Embree has no memory for the scene");
  }
  for (const Eigen::Vector3f& vertex : mesh_.vertices_m) {
    vertices = std::copy_n(vertex.data(), 3, vertices);
  }
  for (const auto& triangle : mesh_.triangles) {
    indices = std::copy_n(triangle.data(), 3, indices);
  }
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(embree_->scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(embree_->scene);
  if (const RTCError error = rtcGetDeviceError(embree_->device); error != RTC_ERROR_NONE) {
    throw std::runtime_error("Embree cannot build the scene: error " + std::to_string(error));
  }
}

Scene::~Scene() = default;
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(Scene&&) noexcept = default;

void Scene::cast(const Eigen::Vector3f& origin_m, std::span<const Directions> directions,
                 std::span<Distances> distances) const {
  const DenormalsOff denormals_off;
  alignas(64) static constexpr std::array<int, kPacketSize> kAllValid = [] {
    std::array<int, kPacketSize> valid{};
    valid.fill(-1);
    return valid;
  }();
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;

  RTCRayHit16 packet{};
  std::fill_n(packet.ray.org_x, kPacketSize, origin_m.x());
  std::fill_n(packet.ray.org_y, kPacketSize, origin_m.y());
  std::fill_n(packet.ray.org_z, kPacketSize, origin_m.z());
  std::fill_n(packet.ray.mask, kPacketSize, ~0U);
  for (std::size_t i = 0; i < directions.size(); ++i) {
    std::copy_n(directions[i].x.data(), kPacketSize, packet.ray.dir_x);
    std::copy_n(directions[i].y.data(), kPacketSize, packet.ray.dir_y);
    std::copy_n(directions[i].z.data(), kPacketSize, packet.ray.dir_z);
    std::fill_n(packet.ray.tfar, kPacketSize, kInfinity);
    std::fill_n(packet.hit.geomID, kPacketSize, RTC_INVALID_GEOMETRY_ID);
    rtcIntersect16(kAllValid.data(), embree_->scene, &context, &packet);
    std::copy_n(packet.ray.tfar, kPacketSize, distances[i].m.data());
  }
}

std::optional<Scene::Hit> Scene::first_hit(const Eigen::Vector3d& origin_m,
                                           const Eigen::Vector3d& direction) const {
  const DenormalsOff denormals_off;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRayHit query{};
  query.ray = ray_along(origin_m.cast<float>(), direction.cast<float>(), kInfinity);
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(embree_->scene, &context, &query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) {
    return std::nullopt;
  }
  return Hit{query.ray.tfar, query.hit.primID};
}

double Scene::clearance_m(const Eigen::Vector3d& a_m, const Eigen::Vector3d& b_m,
                          double at_most_m) const {
  const DenormalsOff denormals_off;
  // In pieces, because a sphere about a long segment holds much that is far from it.
  const double length = (b_m - a_m).norm();
  const int pieces = std::max(1, static_cast<int>(std::ceil(length / std::max(at_most_m, 0.25))));
  double nearest = at_most_m;
  for (int i = 0; i < pieces && nearest > 0.0; ++i) {
    NearestTriangle search{&mesh_, a_m + (b_m - a_m) * (static_cast<double>(i) / pieces),
                           a_m + (b_m - a_m) * (static_cast<double>(i + 1) / pieces), 0.0, nearest};
    search.half_length = 0.5 * (search.b - search.a).norm();
    const Eigen::Vector3d middle = 0.5 * (search.a + search.b);
    RTCPointQuery query{};
    query.x = static_cast<float>(middle.x());
    query.y = static_cast<float>(middle.y());
    query.z = static_cast<float>(middle.z());
    query.radius = search_radius(search, middle);
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(embree_->scene, &query, &context, visit_triangle, &search);
    nearest = search.distance;
  }
  return nearest;
}

}  // namespace nextview

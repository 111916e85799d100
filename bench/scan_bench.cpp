// A whole simulated scan against Embree alone: the same rays, worked out beforehand, in the same
// packets of 16, through a tree built the same way.

#include <benchmark/benchmark.h>
#include <embree3/rtcore.h>
#ifdef __x86_64__
#include <pmmintrin.h>
#include <xmmintrin.h>
#endif

#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <numbers>

#include "bench/bench_groups.h"
#include "bench/recovered_room.h"
#include "lcmtypes/decode.h"
#include "scene/mesh_file.h"
#include "sensor/range_image_message.h"
#include "sensor_sim/scan.h"

namespace nextview {

namespace {

constexpr int kTile = 4;  // a packet is 4 x 4 pixels, as in scan()

class BareEmbree {
 public:
  explicit BareEmbree(const TriangleMesh& mesh) {
    device_ = rtcNewDevice("threads=1,set_affinity=0");
    scene_ = rtcNewScene(device_);
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_MEDIUM);
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    void* vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                             sizeof(Eigen::Vector3f), mesh.vertices_m.size());
    void* indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                            sizeof(mesh.triangles[0]), mesh.triangles.size());
    std::memcpy(vertices, mesh.vertices_m.data(), mesh.vertices_m.size() * sizeof(Eigen::Vector3f));
    std::memcpy(indices, mesh.triangles.data(), mesh.triangles.size() * sizeof(mesh.triangles[0]));
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_);
  }
  BareEmbree(const BareEmbree&) = delete;
  BareEmbree& operator=(const BareEmbree&) = delete;
  ~BareEmbree() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }

  void set_rays(const RayTable& rays, const SensorPose& pose) {
    const Eigen::Matrix3d rotation = world_from_sensor_rotation(pose.pan_rad, pose.tilt_rad);
    const Eigen::Vector3f origin = pose.position_m.cast<float>();
    for (int v0 = 0; v0 < rays.rows(); v0 += kTile) {
      for (int u0 = 0; u0 < rays.columns(); u0 += kTile) {
        RTCRayHit16 packet{};
        for (int i = 0; i < kTile * kTile; ++i) {
          const int v = std::min(v0 + i / kTile, rays.rows() - 1);
          const int u = std::min(u0 + i % kTile, rays.columns() - 1);
          const Eigen::Vector3f direction = (rotation * rays.ray(u, v)).cast<float>();
          packet.ray.org_x[i] = origin.x();
          packet.ray.org_y[i] = origin.y();
          packet.ray.org_z[i] = origin.z();
          packet.ray.dir_x[i] = direction.x();
          packet.ray.dir_y[i] = direction.y();
          packet.ray.dir_z[i] = direction.z();
          packet.ray.mask[i] = ~0U;
        }
        packets_.push_back(packet);
      }
    }
  }

  // Every ray afresh; how far each goes stands in its packet's tfar.
  void cast() {
    alignas(64) static constexpr std::array<int, 16> kAllValid = {-1, -1, -1, -1, -1, -1, -1, -1,
                                                                  -1, -1, -1, -1, -1, -1, -1, -1};
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
#ifdef __x86_64__  // where Embree asks for it, as in scene/scene.cpp
    const unsigned int saved = _mm_getcsr();
    _mm_setcsr(saved | _MM_FLUSH_ZERO_ON | _MM_DENORMALS_ZERO_ON);
#endif
    for (RTCRayHit16& packet : packets_) {
      std::fill_n(packet.ray.tfar, 16, std::numeric_limits<float>::infinity());
      std::fill_n(packet.hit.geomID, 16, RTC_INVALID_GEOMETRY_ID);
      rtcIntersect16(kAllValid.data(), scene_, &context, &packet);
    }
#ifdef __x86_64__
    _mm_setcsr(saved);
#endif
  }

  float range_m(const RayTable& rays, int u, int v) const {
    const int tiles = (rays.columns() + kTile - 1) / kTile;
    const auto packet = static_cast<std::size_t>(v / kTile * tiles + u / kTile);
    return packets_[packet].ray.tfar[v % kTile * kTile + u % kTile];
  }

 private:
  RTCDevice device_;
  RTCScene scene_;
  std::vector<RTCRayHit16> packets_;
};

struct ScanSetting {
  BenchScene scene;
  RayTable rays;
  std::unique_ptr<BareEmbree> embree;
};

RangeImage scan_once(const ScanSetting& setting) {
  RandomStream no_noise(1, 1, 1, RandomPurpose::RangeNoise);
  return scan(setting.scene.scene, setting.rays, RangeLimits(), setting.scene.start, 0.0, no_noise);
}

template <class Scan>
void register_scan(const std::string& name, const std::shared_ptr<ScanSetting>& setting,
                   Scan scan_now) {
  const std::string raster =
      std::to_string(setting->rays.columns()) + "x" + std::to_string(setting->rays.rows());
  benchmark::RegisterBenchmark(
      ("scan/" + name + "/" + setting->scene.name + "/" + raster).c_str(),
      [setting, scan_now](benchmark::State& state) {
        for (auto _ : state) scan_now(*setting);
        state.SetItemsProcessed(state.iterations() *
                                static_cast<std::int64_t>(setting->rays.pixels()));
      })
      ->Unit(benchmark::kMillisecond);
}

void compare_ranges(const ScanSetting& setting) {
  Agreement same("scan/" + setting.scene.name + "/" + std::to_string(setting.rays.columns()) + "x" +
                 std::to_string(setting.rays.rows()) + " embree = nextview");
  setting.embree->cast();
  const RangeImage image = scan_once(setting);
  for (int v = 0; v < setting.rays.rows(); ++v) {
    for (int u = 0; u < setting.rays.columns(); ++u) {
      const float ours = image.range_m[static_cast<std::size_t>(v * setting.rays.columns() + u)];
      const float theirs = setting.embree->range_m(setting.rays, u, v);
      // Both to the 0.1 mm a range image has; a nearer or farther surface than the limits aside.
      same.compare(!std::isfinite(ours) || std::abs(ours - theirs) < 1e-4F);
    }
  }
  same.report("ranges");
}

}  // namespace

void register_scan(const BenchOptions&) {
  const TiltedLineScan large = TiltedLineScan::with_aperture(500, 500, std::numbers::pi / 4.0);
  const std::pair<const char*, TiltedLineScan> settings[] = {
      {"boxes", TiltedLineScan::paper()}, {"boxes", large}, {"conference", large}};
  for (const auto& [name, sensor] : settings) {
    std::shared_ptr<ScanSetting> setting;
    try {
      setting = std::make_shared<ScanSetting>(
          ScanSetting{load_bench_scene(name), make_ray_table(sensor), nullptr});
    } catch (const SceneError& error) {
      report_condition(std::string("skipped scan/") + name, error.what());
      continue;
    }
    setting->embree = std::make_unique<BareEmbree>(setting->scene.scene.mesh());
    setting->embree->set_rays(setting->rays, setting->scene.start);
    compare_ranges(*setting);
    register_scan("embree", setting, [](ScanSetting& s) { s.embree->cast(); });
    register_scan("nextview_range_image", setting,
                  [](ScanSetting& s) { benchmark::DoNotOptimize(scan_once(s)); });
    register_scan("nextview", setting, [](ScanSetting& s) {
      for (const range_image_t& part : range_image_messages(scan_once(s), 1, 1, 0)) {
        benchmark::DoNotOptimize(encode(part));
      }
    });
  }
}

}  // namespace nextview

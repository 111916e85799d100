#include "sensor_sim/strip_caster.h"

#include <algorithm>
#include <array>

#include "sensor/vector_clones.h"

namespace nextview {
namespace {

constexpr int kTileRows = StripCaster::kRows;
constexpr int kTileColumns = Scene::kPacketSize / kTileRows;
static_assert(kTileColumns * kTileRows == Scene::kPacketSize);

// The rows of a strip, by coordinate.
using StripRows = std::array<std::array<RayRow::Along, kTileRows>, 3>;

NEXTVIEW_VECTOR_CLONES
void point_rays(std::size_t tiles, const double* __restrict column_sin,
                const double* __restrict column_cos, const StripRows& rows,
                Scene::Directions* __restrict directions) {
  for (std::size_t tile = 0; tile < tiles; ++tile) {
    const double* sine = column_sin + tile * kTileColumns;
    const double* cosine = column_cos + tile * kTileColumns;
    float* lanes[] = {directions[tile].x.data(), directions[tile].y.data(),
                      directions[tile].z.data()};
    for (std::size_t k = 0; k < 3; ++k) {
      for (int j = 0; j < kTileRows; ++j) {
        const RayRow::Along row = rows[k][static_cast<std::size_t>(j)];
#pragma omp simd
        for (int i = 0; i < kTileColumns; ++i) {
          lanes[k][j * kTileColumns + i] = static_cast<float>(row.ray(sine[i], cosine[i]));
        }
      }
    }
  }
}

}  // namespace

StripCaster::StripCaster(const Scene& scene, const RayTable& rays,
                         const Eigen::Matrix3d& world_from_sensor,
                         const Eigen::Vector3d& position_m)
    : scene_(scene),
      rays_(rays),
      world_from_lines_(rays.world_from_lines(world_from_sensor)),
      origin_m_(position_m.cast<float>()),
      column_sin_(rays.column_sin),
      column_cos_(rays.column_cos),
      directions_((rays.column_sin.size() + kTileColumns - 1) / kTileColumns),
      distances_(directions_.size()) {
  column_sin_.resize(directions_.size() * kTileColumns, column_sin_.back());
  column_cos_.resize(directions_.size() * kTileColumns, column_cos_.back());
}

int StripCaster::rows(int first_row) const { return std::min(kRows, rays_.rows() - first_row); }

std::size_t StripCaster::pixels(int first_row) const {
  return static_cast<std::size_t>(rows(first_row)) * static_cast<std::size_t>(rays_.columns());
}

void StripCaster::cast(int first_row, std::span<float> distance_m) {
  StripRows strip;
  for (int j = 0; j < kTileRows; ++j) {
    const RayRow row = rays_.row(std::min(first_row + j, rays_.rows() - 1), world_from_lines_);
    for (int k = 0; k < 3; ++k) {
      strip[static_cast<std::size_t>(k)][static_cast<std::size_t>(j)] = row.along(k);
    }
  }
  point_rays(directions_.size(), column_sin_.data(), column_cos_.data(), strip, directions_.data());
  scene_.cast(origin_m_, directions_, distances_);

  const auto columns = static_cast<std::size_t>(rays_.columns());
  for (int j = 0; j < rows(first_row); ++j) {
    float* row_m = distance_m.data() + static_cast<std::size_t>(j) * columns;
    for (std::size_t u = 0; u < columns; u += kTileColumns) {
      const float* tile_row_m =
          &distances_[u / kTileColumns].m[static_cast<std::size_t>(j) * kTileColumns];
      std::copy_n(tile_row_m, std::min<std::size_t>(kTileColumns, columns - u), row_m + u);
    }
  }
}

}  // namespace nextview

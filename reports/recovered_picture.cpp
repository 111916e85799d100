#include "reports/recovered_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <string>
#include <unordered_set>

#include "scene/scene.h"

namespace nextview {

namespace {

using Colour = Eigen::Array3f;

// Triangles with a colour each.
struct Painting {
  TriangleMesh mesh;
  std::vector<Colour> colours;

  void add_quad(const Eigen::Vector3d& corner, const Eigen::Vector3d& u, const Eigen::Vector3d& v,
                const Colour& colour) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices_m.size());
    for (const Eigen::Vector3d& vertex :
         {corner, Eigen::Vector3d(corner + u), Eigen::Vector3d(corner + u + v),
          Eigen::Vector3d(corner + v)}) {
      mesh.vertices_m.push_back(vertex.cast<float>());
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first, first + 2, first + 3});
    colours.insert(colours.end(), 2, colour);
  }

  // A square bar from a to b.
  void add_bar(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double width,
               const Colour& colour) {
    const Eigen::Vector3d along = b - a;
    if (along.norm() < 1e-6) return;
    const Eigen::Vector3d u = along.unitOrthogonal() * width;
    const Eigen::Vector3d v = along.cross(u).normalized() * width;
    const Eigen::Vector3d corner = a - 0.5 * (u + v);
    add_quad(corner, along, u, colour);
    add_quad(corner + v, along, u, colour * 0.8F);
    add_quad(corner, along, v, colour * 0.9F);
    add_quad(corner + u, along, v, colour * 0.7F);
    add_quad(corner, u, v, colour);
    add_quad(corner + along, u, v, colour);
  }
};

const Colour kPath(0.95F, 0.45F, 0.10F);
const Colour kPose(0.40F, 0.04F, 0.10F);
const Colour kCanBeSeen(1.00F, 0.00F, 0.00F);
const Colour kNeverVisible(0.72F, 0.72F, 0.72F);

// What remains unseen, by UnseenFrom.
struct UnseenKind {
  Colour colour;
  const char* text;
};
const std::array<UnseenKind, kUnseenFromCount> kUnseen = {{
    {Colour(0.25F, 0.25F, 0.28F), "from nowhere known to be empty"},
    {Colour(0.95F, 0.55F, 0.75F), "only from too near to obstacles"},
    {Colour(0.55F, 0.35F, 0.20F), "only from where no path leads"},
    {Colour(0.45F, 0.30F, 0.75F), "only from beyond the lift or the workspace"},
    {Colour(0.85F, 0.00F, 0.85F), "only from where the base refused to go"},
    {Colour(0.10F, 0.10F, 0.95F), "from where the robot can get to, where views show too little"},
}};

// From blue at the floor over green to yellow at the ceiling.
const std::array<Colour, 5> kScale = {Colour(0.27F, 0.37F, 0.58F), Colour(0.22F, 0.55F, 0.60F),
                                      Colour(0.35F, 0.70F, 0.51F), Colour(0.65F, 0.80F, 0.40F),
                                      Colour(0.93F, 0.86F, 0.45F)};

Colour height_colour(double share) {
  const double place = std::clamp(share, 0.0, 1.0) * (kScale.size() - 1.0);
  const auto below = std::min(static_cast<std::size_t>(place), kScale.size() - 2);
  const auto t = static_cast<float>(place - static_cast<double>(below));
  return kScale[below] * (1.0F - t) + kScale[below + 1] * t;
}

struct Extent {
  Eigen::Vector3d min_m;
  Eigen::Vector3d max_m;
};

std::vector<VoxelIndex> occupied_voxels(const VoxelMap& map) {
  std::vector<VoxelIndex> voxels;
  const VoxelIndex end = map.window().min + map.window().size;
  for (int k = map.window().min[2]; k < end[2]; ++k) {
    for (int j = map.window().min[1]; j < end[1]; ++j) {
      for (int i = map.window().min[0]; i < end[0]; ++i) {
        if (map.label({i, j, k}) == Label::Occupied) voxels.emplace_back(i, j, k);
      }
    }
  }
  return voxels;
}

Extent extent_of(const VoxelMap& map, const std::vector<VoxelIndex>& voxels) {
  VoxelIndex min = voxels.front();
  VoxelIndex max = voxels.front();
  for (const VoxelIndex& voxel : voxels) {
    min = min.cwiseMin(voxel);
    max = max.cwiseMax(voxel);
  }
  return {map.grid().center_m(min), map.grid().center_m(max)};
}

// The faces of a voxel that touch Empty space and look at the camera.
void paint_voxel(const VoxelMap& map, const VoxelIndex& voxel, const Eigen::Vector3d& to_camera,
                 const Colour& colour, Painting& painting) {
  static const std::array<float, 3> kShade = {0.78F, 0.88F, 1.0F};  // by the face's axis
  const double side = map.grid().voxel_size_m;
  // Slightly smaller than the face, so that the voxels can be told apart.
  const double edge = 0.96 * side;
  const Eigen::Vector3d center = map.grid().center_m(voxel);
  for (int axis = 0; axis < 3; ++axis) {
    const VoxelIndex step = (to_camera[axis] < 0.0 ? -1 : 1) * VoxelIndex::Unit(axis);
    if (map.label(voxel + step) != Label::Empty) continue;
    const Eigen::Vector3d u = edge * Eigen::Vector3d::Unit((axis + 1) % 3);
    const Eigen::Vector3d v = edge * Eigen::Vector3d::Unit((axis + 2) % 3);
    painting.add_quad(center + 0.5 * side * step.cast<double>() - 0.5 * (u + v), u, v,
                      colour * kShade[static_cast<std::size_t>(axis)]);
  }
}

void paint_faces(const VoxelMap& map, const std::vector<VoxelIndex>& voxels, const Extent& extent,
                 const Eigen::Vector3d& to_camera, Painting& painting) {
  const double side = map.grid().voxel_size_m;
  const double height = std::max(extent.max_m.z() - extent.min_m.z(), side);
  for (const VoxelIndex& voxel : voxels) {
    const double above_m = map.grid().center_m(voxel).z() - extent.min_m.z();
    paint_voxel(map, voxel, to_camera, height_colour(above_m / height), painting);
  }
}

// By slot, which nothing iterates over.
using Slots = std::unordered_set<std::size_t>;

Slots slots_of(const VoxelMap& map, const std::vector<VoxelIndex>& voxels) {
  Slots slots;
  for (const VoxelIndex& voxel : voxels) slots.insert(map.slot(voxel));
  return slots;
}

void paint_unseen(const VoxelMap& map, const DrawnRun& run, const Eigen::Vector3d& to_camera,
                  Painting& painting) {
  const Slots never = run.missed ? slots_of(map, run.missed->never_visible) : Slots();
  for (const UnseenVoxel& unseen : run.unseen) {
    const Colour& colour = never.contains(map.slot(unseen.voxel))
                               ? kNeverVisible
                               : kUnseen[static_cast<std::size_t>(unseen.from)].colour;
    paint_voxel(map, unseen.voxel, to_camera, colour, painting);
  }
  if (!run.missed) return;
  const double side = 1.05 * map.grid().voxel_size_m;  // around the faces of the voxel
  for (const VoxelIndex& voxel : run.missed->can_be_seen) {
    const Eigen::Vector3d along = side * Eigen::Vector3d::UnitX();
    const Eigen::Vector3d center = map.grid().center_m(voxel);
    painting.add_bar(center - 0.5 * along, center + 0.5 * along, side, kCanBeSeen);
  }
}

void paint_path(std::span<const SensorPose> poses, double bar_m, Painting& painting) {
  constexpr double kDash = 0.08;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Eigen::Vector3d& at = poses[i].position_m;
    const Eigen::Vector3d looks = viewing_direction(poses[i].pan_rad, poses[i].tilt_rad);
    painting.add_bar(at - Eigen::Vector3d(0, 0, bar_m), at + Eigen::Vector3d(0, 0, bar_m),
                     2.0 * bar_m, kPose);
    painting.add_bar(at, at + 0.3 * looks, bar_m, kPose);
    if (i == 0) continue;
    const Eigen::Vector3d from = poses[i - 1].position_m;
    const double length = (at - from).norm();
    for (double begin = 0.0; begin < length; begin += 2.0 * kDash) {
      const double end = std::min(begin + kDash, length);
      painting.add_bar(from + (at - from) * (begin / length), from + (at - from) * (end / length),
                       0.7 * bar_m, kPath);
    }
  }
}

// A camera far away, looking along parallel rays.
struct Camera {
  Eigen::Vector3d corner;  // the picture's top left, in front of everything
  Eigen::Vector3d right;   // one pixel
  Eigen::Vector3d down;
  Eigen::Vector3d direction;
};

Camera camera_for(const Extent& extent, const Eigen::Vector3d& to_camera, const PictureView& view) {
  const Eigen::Vector3d right = Eigen::Vector3d::UnitZ().cross(to_camera).normalized();
  const Eigen::Vector3d up = to_camera.cross(right);
  double half_width = 0.0;
  double half_height = 0.0;
  const Eigen::Vector3d middle = 0.5 * (extent.min_m + extent.max_m);
  for (int corner = 0; corner < 8; ++corner) {
    Eigen::Vector3d at = extent.min_m;
    for (int axis = 0; axis < 3; ++axis) {
      if ((corner >> axis & 1) != 0) at[axis] = extent.max_m[axis];
    }
    half_width = std::max(half_width, std::abs((at - middle).dot(right)));
    half_height = std::max(half_height, std::abs((at - middle).dot(up)));
  }
  const double pixel = 2.08 * std::max(half_width / view.width, half_height / view.height);
  const double away = 2.0 * (extent.max_m - extent.min_m).norm() + 1.0;
  const Eigen::Vector3d corner =
      middle + away * to_camera - 0.5 * view.width * pixel * right + 0.5 * view.height * pixel * up;
  return {corner, pixel * right, -pixel * up, -to_camera};
}

Picture draw(const Scene& scene, const std::vector<Colour>& colours, const Camera& camera,
             const PictureView& view) {
  constexpr int kSamples = 2;  // a side of a pixel
  Picture picture{view.width, view.height, {}};
  picture.rgb.reserve(3 * static_cast<std::size_t>(view.width) *
                      static_cast<std::size_t>(view.height));
  for (int y = 0; y < view.height; ++y) {
    for (int x = 0; x < view.width; ++x) {
      Colour sum = Colour::Zero();
      for (int sample = 0; sample < kSamples * kSamples; ++sample) {
        const int column = sample % kSamples;
        const int row = sample / kSamples;
        const double across = x + (column + 0.5) / kSamples;
        const double along = y + (row + 0.5) / kSamples;
        const auto hit = scene.first_hit(
            camera.corner + across * camera.right + along * camera.down, camera.direction);
        sum += hit ? colours[hit->triangle] : Colour::Ones();
      }
      const Colour mean = (sum / (kSamples * kSamples)).max(0.0F).min(1.0F);
      for (int channel = 0; channel < 3; ++channel) {
        picture.rgb.push_back(static_cast<std::uint8_t>(std::lround(255.0F * mean[channel])));
      }
    }
  }
  return picture;
}

}  // namespace

MissedSurface missed_surface(const VoxelMap& map, std::span<const Eigen::Vector3f> samples_m,
                             std::span<const Eigen::Vector3f> visible_m) {
  Slots taken;
  const auto take_new = [&](std::span<const Eigen::Vector3f> points_m, auto take) {
    for (const Eigen::Vector3f& point_m : points_m) {
      const VoxelIndex voxel = map.grid().voxel_of(point_m.cast<double>());
      if (map.contains(voxel) && taken.insert(map.slot(voxel)).second) take(voxel);
    }
  };
  MissedSurface missed;
  take_new(visible_m, [&](const VoxelIndex& voxel) {
    if (map.label(voxel) != Label::Occupied) missed.can_be_seen.push_back(voxel);
  });
  take_new(samples_m, [&](const VoxelIndex& voxel) {
    const Label label = map.label(voxel);
    const bool known = label == Label::Occupied || label == Label::Empty;
    if (!known) missed.never_visible.push_back(voxel);
  });
  return missed;
}

Picture recovered_picture(const VoxelMap& map, const DrawnRun& run, const PictureView& view) {
  const std::vector<VoxelIndex> voxels = occupied_voxels(map);
  if (voxels.empty()) throw std::invalid_argument("no voxel is Occupied: there is nothing to draw");
  const Extent extent = extent_of(map, voxels);
  const double azimuth = view.azimuth_deg * std::numbers::pi / 180.0;
  const double elevation = view.elevation_deg * std::numbers::pi / 180.0;
  const Eigen::Vector3d to_camera(std::cos(elevation) * std::cos(azimuth),
                                  std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
  Painting painting;
  paint_faces(map, voxels, extent, to_camera, painting);
  paint_unseen(map, run, to_camera, painting);
  paint_path(run.poses, 0.25 * map.grid().voxel_size_m, painting);
  const Camera camera = camera_for(extent, to_camera, view);
  const Scene scene(std::move(painting.mesh));
  return draw(scene, painting.colours, camera, view);
}

std::vector<LegendLine> legend_of(const VoxelMap& map, const DrawnRun& run) {
  const auto rgb = [](const Colour& colour) {
    return std::array<float, 3>{colour[0], colour[1], colour[2]};
  };
  std::vector<LegendLine> legend;
  const auto add = [&](const Colour& from, const Colour& to, std::string text) {
    legend.push_back({rgb(from), rgb(to), std::move(text)});
  };
  const auto square_metres = [&](int faces) {
    const double area_m2 = faces * map.grid().voxel_size_m * map.grid().voxel_size_m;
    return fmt::format("{:.2f} m\u00b2 ", area_m2);
  };
  add(kScale.front(), kScale.back(),
      "recovered surface (Occupied voxels), from the floor to the ceiling; drawn where it faces "
      "space known to be empty and the viewer");
  add(kPath, kPath, "dashes: the straight pieces from view to view");
  add(kPose, kPose, "marks: the poses of the sensor; the bar points to where it looked");
  const Slots never = run.missed ? slots_of(map, run.missed->never_visible) : Slots();
  std::array<int, kUnseenFromCount> faces = {};
  int never_faces = 0;
  for (const UnseenVoxel& unseen : run.unseen) {
    const bool never_visible = never.contains(map.slot(unseen.voxel));
    (never_visible ? never_faces : faces[static_cast<std::size_t>(unseen.from)]) +=
        unseen.empty_faces;
  }
  for (std::size_t i = faces.size(); i-- > 0;) {
    if (faces[i] == 0) continue;
    add(kUnseen[i].colour, kUnseen[i].colour,
        square_metres(faces[i]) + "unseen at the end, and to be seen " + kUnseen[i].text);
  }
  if (run.missed) {
    if (never_faces > 0) {
      add(kNeverVisible, kNeverVisible,
          square_metres(never_faces) +
              "never visible: unseen, and the surface there is seen from nowhere reachable");
    }
    add(kCanBeSeen, kCanBeSeen,
        "cubes: " + std::to_string(run.missed->can_be_seen.size()) +
            " voxels with surface that can be seen from somewhere reachable and is not recovered");
  } else {
    add(Colour::Ones(), Colour::Ones(),
        "what is never visible is not told from what is unseen: no surface coverage is kept");
  }
  add(Colour::Ones(), Colour::Ones(),
      "white gaps: no space known to be empty lies there, or only behind the back of a surface");
  return legend;
}

}  // namespace nextview

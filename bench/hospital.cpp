#include "bench/hospital.h"

#include <array>

namespace nextview {
namespace {

constexpr double kHeight_m = 3.0;
constexpr double kSlab_m = 0.3;
constexpr double kWall_m = 0.1;
constexpr double kCorridor_m = 2.4;
constexpr double kDoorWidth_m = 1.2;
constexpr double kDoorHeight_m = 2.1;
constexpr double kRoomWidth_m = 4.5;  // walls included
constexpr double kRoomDepth_m = 5.0;

class Builder {
 public:
  void box(const Eigen::Vector3d& min, const Eigen::Vector3d& max) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices_m.size());
    for (int corner = 0; corner < 8; ++corner) {
      mesh.vertices_m.emplace_back(static_cast<float>((corner & 1) != 0 ? max.x() : min.x()),
                                   static_cast<float>((corner & 2) != 0 ? max.y() : min.y()),
                                   static_cast<float>((corner & 4) != 0 ? max.z() : min.z()));
    }
    constexpr std::array<std::array<std::uint32_t, 4>, 6> kFaces = {
        {{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}}};
    for (const auto& face : kFaces) {
      mesh.triangles.push_back({first + face[0], first + face[1], first + face[2]});
      mesh.triangles.push_back({first + face[0], first + face[2], first + face[3]});
    }
  }

  /// A wall along x with a door in it.
  void wall_with_door(double x0, double x1, double y) {
    const double door = x0 + 0.6 * (x1 - x0);
    box({x0, y, 0.0}, {door, y + kWall_m, kHeight_m});
    box({door + kDoorWidth_m, y, 0.0}, {x1, y + kWall_m, kHeight_m});
    box({door, y, kDoorHeight_m}, {door + kDoorWidth_m, y + kWall_m, kHeight_m});
  }

  void table(const Eigen::Vector3d& at, double length_m, double width_m, double height_m) {
    constexpr double kTop = 0.04;
    constexpr double kLeg = 0.05;
    box(at + Eigen::Vector3d(0, 0, height_m - kTop),
        at + Eigen::Vector3d(length_m, width_m, height_m));
    for (const double x : {0.0, length_m - kLeg}) {
      for (const double y : {0.0, width_m - kLeg}) {
        box(at + Eigen::Vector3d(x, y, 0),
            at + Eigen::Vector3d(x + kLeg, y + kLeg, height_m - kTop));
      }
    }
  }

  /// A ward or an office; its near corner is inside the walls.
  void furnish(const Eigen::Vector3d& corner, int number) {
    const auto at = [&corner](double x, double y, double z) -> Eigen::Vector3d {
      return corner + Eigen::Vector3d(x, y, z);
    };
    if (number % 3 != 0) {
      for (const double x : {0.3, 2.9}) {
        table(at(x, 0.4, 0.0), 1.0, 2.1, 0.6);         // a bed,
        box(at(x, 0.4, 0.6), at(x + 1.0, 2.5, 0.75));  // its mattress,
        box(at(x, 0.36, 0.0), at(x + 1.0, 0.4, 1.1));  // its head board
      }
      box(at(1.7, 0.0, 0.0), at(2.3, 0.5, 0.8));
    } else {
      table(at(1.0, 0.8, 0.0), 1.6, 0.8, 0.74);
      box(at(3.6, 0.0, 0.0), at(4.3, 0.45, 2.0));
      for (int shelf = 0; shelf < 5; ++shelf) {
        box(at(0.0, 0.0, 0.4 * shelf), at(0.9, 0.35, 0.4 * shelf + 0.03));
      }
    }
  }

  TriangleMesh mesh;
};

}  // namespace

TriangleMesh Hospital::mesh() const {
  Builder builder;
  const double length = kRoomWidth_m * rooms_in_a_row;
  const double pitch = 2.0 * kRoomDepth_m + kCorridor_m;
  const double cross_y = pitch * corridors;
  const double cross_x = length + kCorridor_m;  // a corridor across joins the others
  builder.box({-kWall_m, -kWall_m, -kSlab_m}, {cross_x + kWall_m, cross_y + kWall_m, 0.0});
  builder.box({-kWall_m, -kWall_m, kHeight_m},
              {cross_x + kWall_m, cross_y + kWall_m, kHeight_m + kSlab_m});
  builder.box({-kWall_m, -kWall_m, 0.0}, {0.0, cross_y + kWall_m, kHeight_m});
  builder.box({cross_x, -kWall_m, 0.0}, {cross_x + kWall_m, cross_y + kWall_m, kHeight_m});
  builder.box({0.0, -kWall_m, 0.0}, {cross_x, 0.0, kHeight_m});
  builder.box({0.0, cross_y, 0.0}, {cross_x, cross_y + kWall_m, kHeight_m});
  for (int corridor = 0; corridor < corridors; ++corridor) {
    const double y = pitch * corridor;
    const double near = y + kRoomDepth_m;  // the walls of the corridor
    const double far = near + kCorridor_m - kWall_m;
    if (corridor > 0) builder.box({0.0, y, 0.0}, {length, y + kWall_m, kHeight_m});
    for (const double row_y : {y, y + kRoomDepth_m + kCorridor_m}) {
      builder.box({length, row_y + kWall_m, 0.0},
                  {length + kWall_m, row_y + kRoomDepth_m, kHeight_m});
    }
    for (int room = 0; room < rooms_in_a_row; ++room) {
      const double x = kRoomWidth_m * room;
      builder.wall_with_door(x, x + kRoomWidth_m, near - kWall_m + 0.0);
      builder.wall_with_door(x, x + kRoomWidth_m, far + kWall_m);
      for (const double row_y : {y, y + kRoomDepth_m + kCorridor_m}) {
        if (room > 0) {
          builder.box({x, row_y + kWall_m, 0.0},
                      {x + kWall_m, row_y + kRoomDepth_m - kWall_m, kHeight_m});
        }
        builder.furnish({x + kWall_m, row_y + kWall_m + 0.1, 0.0}, 7 * corridor + room);
      }
    }
  }
  return builder.mesh;
}

}  // namespace nextview

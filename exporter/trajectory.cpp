#include "exporter/trajectory.h"

#include <fmt/ostream.h>

#include <cmath>
#include <numbers>

namespace nextview {
namespace {

constexpr double kDegreesPerRad = 180.0 / std::numbers::pi;

}  // namespace

Eigen::Quaterniond quaternion_of(const StampedPose& pose) {
  const Eigen::Quaterniond q = Eigen::Quaterniond(pose.world_from_sensor).normalized();
  return q.w() < 0.0 ? Eigen::Quaterniond(-q.coeffs()) : q;
}

void write_poses_csv(std::ostream& out, std::span<const StampedPose> poses) {
  out << "view,time_s,x_m,y_m,z_m,pan_deg,tilt_deg,qx,qy,qz,qw\n";
  for (const StampedPose& pose : poses) {
    // Rz(pan) Rx(tilt): its first column is (cos pan, sin pan, 0), its last row (0, sin t, cos t).
    const Eigen::Matrix3d& r = pose.world_from_sensor;
    const double pan_deg = std::atan2(r(1, 0), r(0, 0)) * kDegreesPerRad;
    const double tilt_deg = std::atan2(r(2, 1), r(2, 2)) * kDegreesPerRad;
    const Eigen::Quaterniond q = quaternion_of(pose);
    fmt::print(out, "{},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{:.9f},{:.9f},{:.9f},{:.9f}\n",
               pose.view, pose.time_s, pose.position_m.x(), pose.position_m.y(),
               pose.position_m.z(), pan_deg, tilt_deg, q.x(), q.y(), q.z(), q.w());
  }
}

void write_poses_tum(std::ostream& out, std::span<const StampedPose> poses) {
  out << "# nextview: sensor poses, metres, world frame, z up; the sensor looks along its +y\n"
         "# timestamp tx ty tz qx qy qz qw\n";
  for (const StampedPose& pose : poses) {
    const Eigen::Quaterniond q = quaternion_of(pose);
    fmt::print(out, "{:.6f} {:.6f} {:.6f} {:.6f} {:.9f} {:.9f} {:.9f} {:.9f}\n", pose.time_s,
               pose.position_m.x(), pose.position_m.y(), pose.position_m.z(), q.x(), q.y(), q.z(),
               q.w());
  }
}

}  // namespace nextview

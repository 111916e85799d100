#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

/// Foxglove's well-known messages as JSON, and the JSON schemas they go by, for those of them that
/// a run is told in. Foxglove and Lichtblick know them by their names.
namespace nextview::foxglove {

using Json = nlohmann::ordered_json;

Json time(std::uint64_t time_ns);
Json vector(const Eigen::Vector3d& v);
Json pose(const Eigen::Vector3d& position_m, const Eigen::Quaterniond& orientation);

/// foxglove.FrameTransform: where the child frame lies in its parent.
Json frame_transform(std::uint64_t time_ns, const std::string& parent, const std::string& child,
                     const Eigen::Vector3d& position_m, const Eigen::Quaterniond& orientation);
/// foxglove.PoseInFrame
Json pose_in_frame(std::uint64_t time_ns, const std::string& frame,
                   const Eigen::Vector3d& position_m, const Eigen::Quaterniond& orientation);
/// foxglove.PointCloud of 32-bit floats.
/// @param fields their names, "x", "y", "z" first
/// @param values point by point, fields.size() each
Json point_cloud(std::uint64_t time_ns, const std::string& frame,
                 const std::vector<std::string>& fields, std::span<const float> values);
/// foxglove.SceneUpdate with one entity: a line through points, and an arrow at each pose, which
/// points along its x axis.
Json path_and_arrows(std::uint64_t time_ns, const std::string& frame,
                     std::span<const Eigen::Vector3d> line_m,
                     std::span<const Eigen::Isometry3d> arrows);
/// foxglove.Log, level INFO.
Json log(std::uint64_t time_ns, const std::string& name, const std::string& message);

/// The JSON schema of a message by its name, such as "foxglove.PointCloud".
/// @throws std::invalid_argument for one that is not above
std::string schema(const std::string& name);
/// The JSON schema of a flat message of numbers.
std::string schema_of_numbers(const std::string& name, const std::vector<std::string>& members);

}  // namespace nextview::foxglove

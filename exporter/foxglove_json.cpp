#include "exporter/foxglove_json.h"

#include <bit>
#include <map>
#include <stdexcept>

#include "reports/base64.h"

namespace nextview::foxglove {
namespace {

constexpr std::uint64_t kNanoseconds = 1'000'000'000;

Json quaternion(const Eigen::Quaterniond& q) {
  return {{"x", q.x()}, {"y", q.y()}, {"z", q.z()}, {"w", q.w()}};
}

Json colour(double r, double g, double b) { return {{"r", r}, {"g", g}, {"b", b}, {"a", 1.0}}; }

// Schemas.

Json object(const std::string& title, const Json& properties) {
  return {{"title", title}, {"type", "object"}, {"properties", properties}};
}
Json array_of(const Json& items) { return {{"type", "array"}, {"items", items}}; }
const Json kNumber = {{"type", "number"}};
const Json kInteger = {{"type", "integer"}};
const Json kString = {{"type", "string"}};
const Json kBoolean = {{"type", "boolean"}};

Json time_schema() { return object("time", {{"sec", kInteger}, {"nsec", kInteger}}); }
Json duration_schema() { return object("duration", {{"sec", kInteger}, {"nsec", kInteger}}); }
Json vector_schema() {
  return object("foxglove.Vector3", {{"x", kNumber}, {"y", kNumber}, {"z", kNumber}});
}
Json point_schema() {
  return object("foxglove.Point3", {{"x", kNumber}, {"y", kNumber}, {"z", kNumber}});
}
Json quaternion_schema() {
  return object("foxglove.Quaternion",
                {{"x", kNumber}, {"y", kNumber}, {"z", kNumber}, {"w", kNumber}});
}
Json pose_schema() {
  return object("foxglove.Pose",
                {{"position", vector_schema()}, {"orientation", quaternion_schema()}});
}
Json colour_schema() {
  return object("foxglove.Color", {{"r", kNumber}, {"g", kNumber}, {"b", kNumber}, {"a", kNumber}});
}

Json entity_schema() {
  const Json arrow = object("foxglove.ArrowPrimitive", {{"pose", pose_schema()},
                                                        {"shaft_length", kNumber},
                                                        {"shaft_diameter", kNumber},
                                                        {"head_length", kNumber},
                                                        {"head_diameter", kNumber},
                                                        {"color", colour_schema()}});
  const Json line = object("foxglove.LinePrimitive", {{"type", kInteger},
                                                      {"pose", pose_schema()},
                                                      {"thickness", kNumber},
                                                      {"scale_invariant", kBoolean},
                                                      {"points", array_of(point_schema())},
                                                      {"color", colour_schema()},
                                                      {"colors", array_of(colour_schema())},
                                                      {"indices", array_of(kInteger)}});
  return object("foxglove.SceneEntity", {{"timestamp", time_schema()},
                                         {"frame_id", kString},
                                         {"id", kString},
                                         {"lifetime", duration_schema()},
                                         {"frame_locked", kBoolean},
                                         {"arrows", array_of(arrow)},
                                         {"lines", array_of(line)}});
}

Json schema_json(const std::string& name) {
  if (name == "foxglove.FrameTransform") {
    return object(name, {{"timestamp", time_schema()},
                         {"parent_frame_id", kString},
                         {"child_frame_id", kString},
                         {"translation", vector_schema()},
                         {"rotation", quaternion_schema()}});
  }
  if (name == "foxglove.PoseInFrame") {
    return object(name,
                  {{"timestamp", time_schema()}, {"frame_id", kString}, {"pose", pose_schema()}});
  }
  if (name == "foxglove.PointCloud") {
    const Json field = object("foxglove.PackedElementField",
                              {{"name", kString}, {"offset", kInteger}, {"type", kInteger}});
    return object(name, {{"timestamp", time_schema()},
                         {"frame_id", kString},
                         {"pose", pose_schema()},
                         {"point_stride", kInteger},
                         {"fields", array_of(field)},
                         {"data", {{"type", "string"}, {"contentEncoding", "base64"}}}});
  }
  if (name == "foxglove.SceneUpdate") {
    const Json deletion =
        object("foxglove.SceneEntityDeletion",
               {{"timestamp", time_schema()}, {"type", kInteger}, {"id", kString}});
    return object(name,
                  {{"deletions", array_of(deletion)}, {"entities", array_of(entity_schema())}});
  }
  if (name == "foxglove.Log") {
    return object(name, {{"timestamp", time_schema()},
                         {"level", kInteger},
                         {"message", kString},
                         {"name", kString},
                         {"file", kString},
                         {"line", kInteger}});
  }
  throw std::invalid_argument(name + ": no schema of that name is written");
}

}  // namespace

Json time(std::uint64_t time_ns) {
  return {{"sec", time_ns / kNanoseconds}, {"nsec", time_ns % kNanoseconds}};
}

Json vector(const Eigen::Vector3d& v) { return {{"x", v.x()}, {"y", v.y()}, {"z", v.z()}}; }

Json pose(const Eigen::Vector3d& position_m, const Eigen::Quaterniond& orientation) {
  return {{"position", vector(position_m)}, {"orientation", quaternion(orientation)}};
}

Json frame_transform(std::uint64_t time_ns, const std::string& parent, const std::string& child,
                     const Eigen::Vector3d& position_m, const Eigen::Quaterniond& orientation) {
  return {{"timestamp", time(time_ns)},
          {"parent_frame_id", parent},
          {"child_frame_id", child},
          {"translation", vector(position_m)},
          {"rotation", quaternion(orientation)}};
}

Json pose_in_frame(std::uint64_t time_ns, const std::string& frame,
                   const Eigen::Vector3d& position_m, const Eigen::Quaterniond& orientation) {
  return {
      {"timestamp", time(time_ns)}, {"frame_id", frame}, {"pose", pose(position_m, orientation)}};
}

Json point_cloud(std::uint64_t time_ns, const std::string& frame,
                 const std::vector<std::string>& fields, std::span<const float> values) {
  constexpr int kFloat32 = 7;
  Json packed = Json::array();
  for (std::size_t i = 0; i < fields.size(); ++i) {
    packed.push_back({{"name", fields[i]}, {"offset", 4 * i}, {"type", kFloat32}});
  }
  std::vector<unsigned char> bytes;
  bytes.reserve(4 * values.size());
  for (const float value : values) {
    const auto bits = std::bit_cast<std::uint32_t>(value);
    for (int byte = 0; byte < 4; ++byte) {
      bytes.push_back(static_cast<unsigned char>(bits >> (8 * byte)));
    }
  }
  return {{"timestamp", time(time_ns)},
          {"frame_id", frame},
          {"pose", pose(Eigen::Vector3d::Zero(), Eigen::Quaterniond::Identity())},
          {"point_stride", 4 * fields.size()},
          {"fields", packed},
          {"data", base64(bytes)}};
}

Json path_and_arrows(std::uint64_t time_ns, const std::string& frame,
                     std::span<const Eigen::Vector3d> line_m,
                     std::span<const Eigen::Isometry3d> arrows) {
  Json points = Json::array();
  for (const Eigen::Vector3d& point : line_m) points.push_back(vector(point));
  Json arrow_list = Json::array();
  for (const Eigen::Isometry3d& arrow : arrows) {
    arrow_list.push_back({{"pose", pose(arrow.translation(), Eigen::Quaterniond(arrow.rotation()))},
                          {"shaft_length", 0.2},
                          {"shaft_diameter", 0.03},
                          {"head_length", 0.1},
                          {"head_diameter", 0.08},
                          {"color", colour(0.85, 0.2, 0.15)}});
  }
  constexpr int kLineStrip = 0;
  const Json line = {{"type", kLineStrip},
                     {"pose", pose(Eigen::Vector3d::Zero(), Eigen::Quaterniond::Identity())},
                     {"thickness", 0.02},
                     {"scale_invariant", false},
                     {"points", points},
                     {"color", colour(0.2, 0.2, 0.2)},
                     {"colors", Json::array()},
                     {"indices", Json::array()}};
  const Json entity = {{"timestamp", time(time_ns)},
                       {"frame_id", frame},
                       {"id", "path"},
                       {"lifetime", {{"sec", 0}, {"nsec", 0}}},
                       {"frame_locked", false},
                       {"arrows", arrow_list},
                       {"lines", Json::array({line})}};
  return {{"deletions", Json::array()}, {"entities", Json::array({entity})}};
}

Json log(std::uint64_t time_ns, const std::string& name, const std::string& message) {
  constexpr int kInfo = 2;
  return {{"timestamp", time(time_ns)},
          {"level", kInfo},
          {"message", message},
          {"name", name},
          {"file", ""},
          {"line", 0}};
}

std::string schema(const std::string& name) { return schema_json(name).dump(); }

std::string schema_of_numbers(const std::string& name, const std::vector<std::string>& members) {
  Json properties = {{"timestamp", time_schema()}};
  for (const std::string& member : members) properties[member] = kNumber;
  return object(name, properties).dump();
}

}  // namespace nextview::foxglove

#include "scoring/position_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

namespace nextview {
namespace {

/// Fewer positions are looked at one by one.
constexpr std::int32_t kLeafPositions = 4;
/// For fewer positions a union of shadows costs more than it saves.
constexpr std::int32_t kUnionPositions = 512;
/// Where a union was not clear so often in a row, it is tried again for the 4th, 8th ... 64th
/// point.
constexpr std::uint8_t kMostUnclear = 4;
/// Rays cast for what a union leaves open; more are better spent on smaller boxes.
constexpr int kMostCasts = 256;

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

double squared(double value) { return value * value; }

}  // namespace

std::optional<std::uint32_t> hidden_by(const Scene& scene, const Eigen::Vector3d& point_m,
                                       const Eigen::Vector3d& position_m) {
  const Eigen::Vector3d sight = position_m - point_m;
  const double distance_m = sight.norm();
  if (distance_m <= kLineOfSightGap_m) return std::nullopt;
  const Eigen::Vector3d direction = sight / distance_m;
  const auto hit = scene.first_hit(point_m + kLineOfSightGap_m * direction, direction);
  if (!hit || hit->distance_m >= distance_m - kLineOfSightGap_m) return std::nullopt;
  return hit->triangle;
}

bool clearly_hides(const TriangleMesh& mesh, std::uint32_t triangle, const Eigen::Vector3d& point_m,
                   const Eigen::Vector3d& position_m) {
  const Eigen::Vector3d a = mesh.corner_m(triangle, 0) - point_m;
  const Eigen::Vector3d b = mesh.corner_m(triangle, 1) - point_m;
  const Eigen::Vector3d c = mesh.corner_m(triangle, 2) - point_m;
  const Eigen::Vector3d sight = position_m - point_m;
  const double length_m = sight.norm();
  const Eigen::Vector3d normal = (b - a).cross(c - a);
  const double approach = normal.dot(sight);
  const double met_m = normal.dot(a) / approach * length_m;  // NaN or infinite when in the plane
  // A ray starts at the gap, and where it meets the triangle depends on how flat it comes.
  const double flat_m = kShadowMargin * normal.norm() * length_m / std::abs(approach);
  if (!(met_m > kLineOfSightGap_m + flat_m && met_m < length_m - kLineOfSightGap_m - flat_m)) {
    return false;
  }
  // So far from the edges, as the directions of rays and their origins are rounded.
  const double least_sine = kShadowMargin * (1.0 + 1.0 / met_m);
  const double side = approach < 0.0 ? -1.0 : 1.0;
  const auto inside = [&](const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    const Eigen::Vector3d edge = from.cross(to);
    const double depth = side * edge.dot(sight);
    return depth > 0.0 && squared(depth) > squared(least_sine * length_m) * edge.squaredNorm();
  };
  return inside(a, b) && inside(b, c) && inside(c, a);
}

PositionTree::PositionTree(std::vector<Eigen::Vector3d> positions, const std::stop_token& stop)
    : positions_(std::move(positions)) {
  if (positions_.empty()) throw std::invalid_argument("position tree: no positions");
  nodes_.reserve(2 * positions_.size() / kLeafPositions + 1);
  build(0, static_cast<std::int32_t>(positions_.size()), stop);
}

std::int32_t PositionTree::build(std::int32_t begin, std::int32_t end,
                                 const std::stop_token& stop) {
  Node node;
  node.begin = begin;
  node.end = end;
  for (std::int32_t i = begin; i < end; ++i) node.box.extend(position_m(i));
  if (node.size() > kLeafPositions && !stop.stop_requested()) {
    Eigen::Index axis = 0;
    node.box.sizes().maxCoeff(&axis);
    const std::int32_t half = begin + node.size() / 2;
    std::nth_element(
        positions_.begin() + begin, positions_.begin() + half, positions_.begin() + end,
        [axis](const Eigen::Vector3d& a, const Eigen::Vector3d& b) { return a[axis] < b[axis]; });
    node.left = build(begin, half, stop);
    node.right = build(half, end, stop);
  }
  const Eigen::Vector3d middle = node.box.center();
  const auto nearest =
      std::min_element(positions_.begin() + begin, positions_.begin() + end,
                       [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
                         return (a - middle).squaredNorm() < (b - middle).squaredNorm();
                       });
  node.middle = static_cast<std::int32_t>(nearest - positions_.begin());
  nodes_.push_back(node);
  return static_cast<std::int32_t>(nodes_.size()) - 1;
}

PositionSearch::PositionSearch(const Scene& scene, const TriangleNeighbours& neighbours,
                               const PositionTree& tree, double range_max_m)
    : scene_(&scene),
      tree_(&tree),
      range_max_m_(range_max_m),
      surface_(neighbours),
      union_(scene, neighbours),
      hider_(tree.size(), kNone),
      node_hider_(static_cast<std::size_t>(tree.root()) + 1, kNone) {}

bool PositionSearch::sees(const Eigen::Vector3d& point_m) {
  point_m_ = point_m;
  return position_sees(last_seen_from_) || node_sees(tree_->root(), std::nullopt);
}

/// A triangle that hides a position, or nothing.
std::optional<std::uint32_t> PositionSearch::hider_of(std::int32_t position) {
  std::uint32_t& last = hider_[static_cast<std::size_t>(position)];
  const Eigen::Vector3d& at = tree_->position_m(position);
  if (last != kNone && clearly_hides(scene_->mesh(), last, point_m_, at)) return last;
  const std::optional<std::uint32_t> triangle = hidden_by(*scene_, point_m_, at);
  if (triangle) last = *triangle;
  return triangle;
}

bool PositionSearch::position_sees(std::int32_t position) {
  const Eigen::Vector3d& at = tree_->position_m(position);
  if ((at - point_m_).squaredNorm() > squared(range_max_m_) || hider_of(position)) return false;
  last_seen_from_ = position;
  return true;
}

bool PositionSearch::node_sees(std::int32_t at, std::optional<Blocked> known) {
  const PositionTree::Node& node = tree_->node(at);
  if (node.box.squaredExteriorDistance(point_m_) > squared(range_max_m_)) return false;
  if (node.left < 0) {
    for (std::int32_t i = node.begin; i < node.end; ++i) {
      if (position_sees(i)) return true;
    }
    return false;
  }
  std::uint32_t& last = node_hider_[static_cast<std::size_t>(at)];
  const Eigen::Vector3d& middle = tree_->position_m(node.middle);
  if (last != kNone && surface_.hides(last, point_m_, middle, node.box)) return false;
  if (!known || known->position != node.middle) {
    const auto triangle = hider_of(node.middle);
    if (!triangle && (middle - point_m_).norm() <= range_max_m_) {
      last_seen_from_ = node.middle;
      return true;
    }
    known.reset();
    if (triangle) known = Blocked{node.middle, *triangle};
  }
  if (known && surface_.hides(known->triangle, point_m_, middle, node.box)) {
    last = known->triangle;
    return false;
  }
  if (known && node.size() >= kUnionPositions) {
    if (const std::optional<bool> seen = union_sees(at)) return *seen;
  }

  std::pair<std::int32_t, std::int32_t> children{node.left, node.right};
  const auto distance = [&](std::int32_t child) {
    return tree_->node(child).box.squaredExteriorDistance(point_m_);
  };
  if (distance(children.second) < distance(children.first)) {
    std::swap(children.first, children.second);
  }
  return node_sees(children.first, known) || node_sees(children.second, known);
}

/// Whether some position of a node sees the point, when triangles together hide all but pieces.
std::optional<bool> PositionSearch::union_sees(std::int32_t at) {
  UnionMemory& memory = unions_[at];
  // What was not clear from a neighbouring point seldom is from this one.
  if (memory.skip > 0) {
    --memory.skip;
    return std::nullopt;
  }
  const auto not_clear = [&memory]() -> std::optional<bool> {
    memory.skip = static_cast<std::uint8_t>((4U << memory.unclear) - 1U);
    memory.unclear = std::min<std::uint8_t>(kMostUnclear, memory.unclear + 1U);
    return std::nullopt;
  };
  if (!union_.hides(point_m_, tree_->node(at).box, memory.triangles, open_)) return not_clear();
  casts_left_ = kMostCasts;
  const bool seen = std::any_of(open_.begin(), open_.end(),
                                [&](SpacePiece& piece) { return sees_in_piece(at, piece); });
  if (!seen && casts_left_ == 0) return not_clear();
  memory.unclear = 0;
  return seen;
}

/// Whether some position of a node in a piece of space, or next to it, sees the point.
bool PositionSearch::sees_in_piece(std::int32_t at, SpacePiece& piece) {
  const PositionTree::Node& node = tree_->node(at);
  if (casts_left_ == 0 || !node.box.intersects(piece.box)) return false;
  const Eigen::Vector3d middle = node.box.center() - point_m_;
  const Eigen::Vector3d half_sides = 0.5 * node.box.sizes();
  const double margin_m = kShadowMargin * (1.0 + middle.norm() + half_sides.norm());
  for (std::size_t i = 0; i < piece.size; ++i) {
    const auto& [normal, offset_m] = piece.half_spaces[i];
    if (normal.dot(middle) + normal.cwiseAbs().dot(half_sides) < offset_m - margin_m) {
      std::swap(piece.half_spaces[0], piece.half_spaces[i]);  // keeps the next boxes out too
      return false;
    }
  }
  if (node.left >= 0) return sees_in_piece(node.left, piece) || sees_in_piece(node.right, piece);
  for (std::int32_t i = node.begin; i < node.end && casts_left_ > 0; ++i) {
    const Eigen::Vector3d sight = tree_->position_m(i) - point_m_;
    const double off_m = kShadowMargin * (1.0 + sight.norm());
    const bool inside = std::all_of(
        piece.half_spaces.begin(), piece.half_spaces.begin() + piece.size,
        [&](const HalfSpace& space) { return space.normal.dot(sight) >= space.offset_m - off_m; });
    if (!inside) continue;
    --casts_left_;
    if (position_sees(i)) return true;
  }
  return false;
}

}  // namespace nextview

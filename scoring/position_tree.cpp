#include "scoring/position_tree.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace nextview {
namespace {

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

PositionTree::PositionTree(const Scene& scene, const TriangleNeighbours& neighbours,
                           std::vector<Eigen::Vector3d> positions, double range_max_m)
    : scene_(&scene),
      positions_(std::move(positions)),
      range_max_m_(range_max_m),
      shadow_(neighbours) {
  if (positions_.empty()) throw std::invalid_argument("position tree: no positions");
  std::vector<std::int32_t> order(positions_.size());
  std::iota(order.begin(), order.end(), 0);
  nodes_.reserve(2 * positions_.size());
  root_ = build(order.data(), order.data() + order.size());
}

std::int32_t PositionTree::build(std::int32_t* begin, std::int32_t* end) {
  const auto position = [this](std::int32_t i) -> const Eigen::Vector3d& {
    return positions_[static_cast<std::size_t>(i)];
  };
  Node node;
  for (const std::int32_t* i = begin; i != end; ++i) node.box.extend(position(*i));
  const Eigen::Vector3d middle = node.box.center();
  node.representative = *std::min_element(begin, end, [&](std::int32_t a, std::int32_t b) {
    return (position(a) - middle).squaredNorm() < (position(b) - middle).squaredNorm();
  });
  if (end - begin > 1) {
    Eigen::Index axis = 0;
    node.box.sizes().maxCoeff(&axis);
    std::int32_t* const half = begin + (end - begin) / 2;
    std::nth_element(begin, half, end, [&](std::int32_t a, std::int32_t b) {
      return position(a)[axis] < position(b)[axis];
    });
    node.left = build(begin, half);
    node.right = build(half, end);
  }
  nodes_.push_back(node);
  return static_cast<std::int32_t>(nodes_.size()) - 1;
}

bool PositionTree::sees(const Eigen::Vector3d& point_m) {
  const Eigen::Vector3d& likely = positions_[static_cast<std::size_t>(last_seen_from_)];
  if ((likely - point_m).norm() <= range_max_m_ && !hidden_by(*scene_, point_m, likely)) {
    return true;
  }
  return node_sees(root_, point_m, std::nullopt);
}

bool PositionTree::node_sees(std::int32_t at, const Eigen::Vector3d& point_m,
                             std::optional<Blocked> known) {
  Node& node = nodes_[static_cast<std::size_t>(at)];
  if (node.box.squaredExteriorDistance(point_m) > squared(range_max_m_)) return false;
  const Eigen::Vector3d& position = positions_[static_cast<std::size_t>(node.representative)];
  if (node.last_shadow && shadow_.hides(*node.last_shadow, point_m, position, node.box)) {
    return false;
  }
  if (!known || known->position != node.representative) {
    const auto triangle = hidden_by(*scene_, point_m, position);
    if (!triangle && (position - point_m).norm() <= range_max_m_) {
      last_seen_from_ = node.representative;
      return true;
    }
    known.reset();
    if (triangle) known = Blocked{node.representative, *triangle};
  }
  if (known && shadow_.hides(known->triangle, point_m, position, node.box)) {
    node.last_shadow = known->triangle;
    return false;
  }
  if (node.left < 0) return false;

  std::pair<std::int32_t, std::int32_t> children{node.left, node.right};
  const auto distance = [&](std::int32_t child) {
    return nodes_[static_cast<std::size_t>(child)].box.squaredExteriorDistance(point_m);
  };
  if (distance(children.second) < distance(children.first)) {
    std::swap(children.first, children.second);
  }
  return node_sees(children.first, point_m, known) || node_sees(children.second, point_m, known);
}

}  // namespace nextview

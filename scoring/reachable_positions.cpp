#include "scoring/reachable_positions.h"

#include <algorithm>
#include <array>
#include <bitset>
#include <cmath>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <tuple>
#include <unordered_map>

#include "scoring/coverage_unknown.h"

namespace nextview {
namespace {

using Node = Eigen::Vector3i;

/// A lattice index as one number: 21 bits an axis, far more than any box holds.
std::uint64_t key_of(const Node& node) {
  constexpr int kOffset = 1 << 20;
  std::uint64_t key = 0;
  for (int axis = 2; axis >= 0; --axis) {
    key = key << 21 | static_cast<std::uint64_t>(node[axis] + kOffset);
  }
  return key;
}

/// Calls visit(node) for the nodes of a box, both corners included.
template <class Visit>
void for_each_node(const Node& min, const Node& max, const Visit& visit) {
  for (int z = min.z(); z <= max.z(); ++z) {
    for (int y = min.y(); y <= max.y(); ++y) {
      for (int x = min.x(); x <= max.x(); ++x) visit(Node(x, y, z));
    }
  }
}

/// The lattice over a scene; asks for the clearance of each point once. What is known of its points
/// is kept in blocks of 8 x 8 x 8, as free space comes in rooms and not in single points.
class Lattice {
 public:
  Lattice(const Scene& scene, const ReachParameters& parameters)
      : scene_(&scene), parameters_(&parameters) {}

  Eigen::Vector3d position_m(const Node& node) const {
    return parameters_->spacing_m * node.cast<double>();
  }

  bool is_free(const Node& node) { return clearance_m(node) >= parameters_->clearance_m; }

  /// Whether the straight piece between two free neighbours keeps the clearance. No point of it is
  /// farther from the nearer end than half its length, which most often is all that has to be
  /// known.
  bool joined(const Node& a, const Node& b) {
    const Eigen::Vector3d a_m = position_m(a);
    const Eigen::Vector3d b_m = position_m(b);
    const double least_m = 0.5 * (clearance_m(a) + clearance_m(b) - (b_m - a_m).norm());
    return least_m >= parameters_->clearance_m || clear(a_m, b_m);
  }

  bool clear(const Eigen::Vector3d& a_m, const Eigen::Vector3d& b_m) const {
    return scene_->clearance_m(a_m, b_m, parameters_->clearance_m) >= parameters_->clearance_m;
  }

  bool is_reached(const Node& node) { return block_of(node).reached[place_in_block(node)]; }
  void set_reached(const Node& node) { block_of(node).reached[place_in_block(node)] = true; }

 private:
  static constexpr int kBits = 3;
  static constexpr std::size_t kNodes = 1U << 3 * kBits;
  struct Block {
    std::array<double, kNodes> clearance_m;
    std::bitset<kNodes> asked;
    std::bitset<kNodes> reached;
  };

  static std::size_t place_in_block(const Node& node) {
    constexpr int kMask = (1 << kBits) - 1;
    const auto part = [&](int axis) { return static_cast<std::size_t>(node[axis] & kMask); };
    return part(0) | part(1) << kBits | part(2) << 2 * kBits;
  }
  Block& block_of(const Node& node) {
    const std::uint64_t key = key_of(Node(node.x() >> kBits, node.y() >> kBits, node.z() >> kBits));
    if (last_ == nullptr || key != last_key_) {  // mostly the one asked for before
      std::unique_ptr<Block>& block = blocks_[key];
      if (!block) block = std::make_unique<Block>();
      last_ = block.get();
      last_key_ = key;
    }
    return *last_;
  }

  /// Up to what joined() can use; negative outside the box.
  double clearance_m(const Node& node) {
    Block& block = block_of(node);
    const std::size_t place = place_in_block(node);
    double& known_m = block.clearance_m[place];
    if (!block.asked[place]) {
      block.asked[place] = true;
      known_m = -1.0;
      const Eigen::Vector3d at = position_m(node);
      const bool inside = (at.array() >= parameters_->box_min_m.array()).all() &&
                          (at.array() <= parameters_->box_max_m.array()).all();
      const double enough_m = parameters_->clearance_m + parameters_->spacing_m * std::sqrt(3.0);
      if (inside) known_m = scene_->clearance_m(at, at, enough_m);
    }
    return known_m;
  }

  const Scene* scene_;
  const ReachParameters* parameters_;
  std::unordered_map<std::uint64_t, std::unique_ptr<Block>> blocks_;  ///< looked up only
  Block* last_ = nullptr;
  std::uint64_t last_key_ = 0;
};

void check(const Eigen::Vector3d& start_m, const ReachParameters& parameters) {
  if (!(parameters.spacing_m > 0.0) || !std::isfinite(parameters.spacing_m) ||
      !std::isfinite(parameters.clearance_m) || !std::isfinite(parameters.join_within_m) ||
      !start_m.allFinite() || !parameters.box_min_m.allFinite() ||
      !parameters.box_max_m.allFinite()) {
    throw std::invalid_argument(
        "reachable positions: spacing, clearance, start and box "
        "must be finite, the spacing positive");
  }
}

/// The nearest lattice point that the start gets to in a straight free piece.
std::optional<Node> node_joined_by(const Eigen::Vector3d& start_m, Lattice& lattice,
                                   const ReachParameters& parameters) {
  const auto node_beside = [&](double offset_m) -> Node {
    return ((start_m.array() + offset_m) / parameters.spacing_m).round().cast<int>();
  };
  std::vector<std::pair<double, Node>> candidates;
  for_each_node(node_beside(-parameters.join_within_m), node_beside(parameters.join_within_m),
                [&](const Node& node) {
                  const double distance_m = (lattice.position_m(node) - start_m).norm();
                  if (distance_m <= parameters.join_within_m && lattice.is_free(node)) {
                    candidates.emplace_back(distance_m, node);
                  }
                });
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  for (const auto& [distance_m, node] : candidates) {
    if (lattice.clear(start_m, lattice.position_m(node))) return node;
  }
  return std::nullopt;
}

}  // namespace

std::vector<Eigen::Vector3d> reachable_positions(const Scene& scene, const Eigen::Vector3d& start_m,
                                                 const ReachParameters& parameters,
                                                 const std::stop_token& stop,
                                                 WorkProgress* progress) {
  check(start_m, parameters);
  Lattice lattice(scene, parameters);
  const std::optional<Node> first = node_joined_by(start_m, lattice, parameters);
  if (!first) return {};
  std::vector<Node> nodes = {*first};
  lattice.set_reached(*first);
  if (progress != nullptr) progress->begin("positions reached", 0);
  // Breadth first; the vector grows behind the one being looked at.
  for (std::size_t at = 0; at < nodes.size() && !stop.stop_requested(); ++at) {
    const Node from = nodes[at];
    for_each_node(from - Node::Ones(), from + Node::Ones(), [&](const Node& to) {
      if (lattice.is_reached(to) || !lattice.is_free(to) || !lattice.joined(from, to)) return;
      lattice.set_reached(to);
      nodes.push_back(to);
    });
    if (progress != nullptr) progress->done = static_cast<std::int64_t>(nodes.size());
    if (static_cast<std::int64_t>(nodes.size()) > parameters.most_positions) {
      throw CoverageUnknown("the free space holds more than " +
                            std::to_string(parameters.most_positions) + " positions");
    }
  }
  if (stop.stop_requested()) return {};
  std::sort(nodes.begin(), nodes.end(), [](const Node& a, const Node& b) {
    return std::tuple(a.z(), a.y(), a.x()) < std::tuple(b.z(), b.y(), b.x());
  });
  std::vector<Eigen::Vector3d> positions;
  positions.reserve(nodes.size());
  for (const Node& node : nodes) positions.push_back(lattice.position_m(node));
  return positions;
}

}  // namespace nextview

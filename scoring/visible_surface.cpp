#include "scoring/visible_surface.h"

#include <algorithm>
#include <optional>

#include "scoring/coverage_unknown.h"
#include "scoring/kept_file.h"
#include "scoring/on_all_cores.h"
#include "scoring/position_tree.h"
#include "scoring/surface_samples.h"

namespace nextview {
namespace {

/// What is looked at, and from where.
struct Question {
  std::vector<Eigen::Vector3d> positions_m;
  std::vector<Eigen::Vector3f> samples_m;
  double samples_per_m2 = 0.0;
};

Question question_of(const Scene& scene, const Eigen::Vector3d& start_m,
                     const VisibilityParameters& parameters, const std::stop_token& stop,
                     WorkProgress* progress) {
  Question question;
  question.positions_m = reachable_positions(scene, start_m, parameters.reach, stop, progress);
  if (stop.stop_requested()) return question;
  if (question.positions_m.empty()) {
    throw CoverageUnknown("nothing can be reached from the start at the run's clearance");
  }
  const double most_per_m2 = static_cast<double>(parameters.most_samples) / scene.mesh().area_m2();
  question.samples_per_m2 = std::min(parameters.samples_per_m2, most_per_m2);
  question.samples_m = sample_surface(scene.mesh(), question.samples_per_m2, stop);
  return question;
}

/// Tells of each sample whether it can be seen from the positions, on all cores.
std::vector<std::uint8_t> seen_samples(const Scene& scene, const Question& question,
                                       double range_max_m, const std::stop_token& stop,
                                       WorkProgress& progress) {
  constexpr std::size_t kSamplesAtATime = 1024;  // neighbours, who can learn from each other
  const std::vector<Eigen::Vector3f>& samples = question.samples_m;
  std::vector<std::uint8_t> seen(samples.size(), 0);
  const TriangleNeighbours neighbours(scene.mesh(), stop);
  const PositionTree tree(question.positions_m, stop);
  if (stop.stop_requested()) return seen;
  progress.begin("surface that can be seen", static_cast<std::int64_t>(samples.size()));
  std::atomic<std::size_t> next = 0;
  on_all_cores([&] {
    PositionSearch search(scene, neighbours, tree, range_max_m);
    while (!stop.stop_requested()) {
      const std::size_t first = next.fetch_add(kSamplesAtATime);
      const std::size_t last = std::min(first + kSamplesAtATime, samples.size());
      if (first >= last) return;
      for (std::size_t i = first; i < last && !stop.stop_requested(); ++i) {
        seen[i] = search.sees(samples[i].cast<double>()) ? 1 : 0;
      }
      progress.done += static_cast<std::int64_t>(last - first);
    }
  });
  return seen;
}

VisibleSurface surface_of(const Question& question, const std::vector<std::uint8_t>& seen) {
  VisibleSurface surface;
  surface.samples = static_cast<std::int64_t>(question.samples_m.size());
  surface.positions = static_cast<std::int64_t>(question.positions_m.size());
  surface.samples_per_m2 = question.samples_per_m2;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (seen[i] != 0) surface.points_m.push_back(question.samples_m[i]);
  }
  return surface;
}

/// Everything the answer depends on.
std::string key_of(const std::string& scene_digest, const Question& question,
                   const VisibilityParameters& parameters) {
  KeptKey key("visible surface", 1);
  key.add(scene_digest);
  key.add(parameters.range_max_m);
  key.add(question.samples_per_m2);
  for (const Eigen::Vector3d& position : question.positions_m) {
    for (int axis = 0; axis < 3; ++axis) key.add(position[axis]);
  }
  return key.text();
}

/// One bit a sample.
std::string packed(const std::vector<std::uint8_t>& seen) {
  std::string bits((seen.size() + 7) / 8, '\0');
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (seen[i] != 0) bits[i / 8] = static_cast<char>(bits[i / 8] | 1 << i % 8);
  }
  return bits;
}

std::optional<std::vector<std::uint8_t>> unpacked(const std::string& bits, std::size_t samples) {
  if (bits.size() != (samples + 7) / 8) return std::nullopt;
  std::vector<std::uint8_t> seen(samples);
  for (std::size_t i = 0; i < samples; ++i) {
    seen[i] = static_cast<std::uint8_t>(static_cast<unsigned char>(bits[i / 8]) >> i % 8 & 1);
  }
  return seen;
}

std::optional<VisibleSurface> kept_answer(const std::string& folder, const std::string& key,
                                          const Question& question) {
  if (folder.empty()) return std::nullopt;
  const auto bits = read_kept(folder, key);
  if (!bits) return std::nullopt;
  const auto seen = unpacked(*bits, question.samples_m.size());
  if (!seen) return std::nullopt;
  return surface_of(question, *seen);
}

}  // namespace

VisibleSurface visible_surface(const Scene& scene, const Eigen::Vector3d& start_m,
                               const VisibilityParameters& parameters, const std::stop_token& stop,
                               WorkProgress* progress) {
  return kept_visible_surface({}, scene, {}, start_m, parameters, stop, progress);
}

VisibleSurface kept_visible_surface(const std::string& folder, const Scene& scene,
                                    const std::string& scene_digest, const Eigen::Vector3d& start_m,
                                    const VisibilityParameters& parameters,
                                    const std::stop_token& stop, WorkProgress* progress) {
  const Question question = question_of(scene, start_m, parameters, stop, progress);
  if (stop.stop_requested()) return {};
  const std::string key = folder.empty() ? "" : key_of(scene_digest, question, parameters);
  if (const auto kept = kept_answer(folder, key, question)) return *kept;
  WorkProgress unwatched;
  const std::vector<std::uint8_t> seen =
      seen_samples(scene, question, parameters.range_max_m, stop, progress ? *progress : unwatched);
  if (!folder.empty() && !stop.stop_requested()) keep(folder, key, packed(seen));
  return surface_of(question, seen);
}

std::optional<VisibleSurface> visible_surface_if_kept(const std::string& folder, const Scene& scene,
                                                      const std::string& scene_digest,
                                                      const Eigen::Vector3d& start_m,
                                                      const VisibilityParameters& parameters) {
  const Question question = question_of(scene, start_m, parameters, {}, nullptr);
  return kept_answer(folder, key_of(scene_digest, question, parameters), question);
}

}  // namespace nextview

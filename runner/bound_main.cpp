#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <exception>
#include <iostream>
#include <thread>

#include "lcmtypes/standard_output.h"
#include "runner/run_options.h"
#include "runner/run_setup.h"
#include "runner/run_signals.h"
#include "scoring/kept_file.h"

namespace {

using nextview::ViewBound;

constexpr const char* kDescription =
    "How few views and metres a scene takes at least, for the start, clearance and sensor of a "
    "run:\n"
    "those of a greedy who knows the scene, and what no planner can be below, over positions at a\n"
    "spacing (--bound-spacing) and 320 orientations. Takes the options of ./run. What it finds is\n"
    "kept (--cache).\n";

/// Says how far the work is, and has it end on a signal.
class Watch {
 public:
  Watch() : thread_([this](const std::stop_token& over) { watch(over); }) {}

  std::stop_token stop() const { return source_.get_token(); }
  nextview::WorkProgress& progress() { return progress_; }

 private:
  void watch(const std::stop_token& over) {
    for (int tick = 1; !over.stop_requested(); ++tick) {
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
      if (nextview::noted_signal() != 0) source_.request_stop();
      if (tick % 40 == 0) show();
    }
  }

  void show() const {
    const std::int64_t of = progress_.of;
    const std::int64_t done = progress_.done;
    const std::string stage = progress_.stage.load();
    if (stage.empty()) return;
    std::cerr << "  " << stage << ": "
              << (of > 0 ? fmt::format("{} %", 100 * done / of) : fmt::format("{}", done))
              << std::endl;
  }

  std::stop_source source_;
  nextview::WorkProgress progress_;
  std::jthread thread_;
};

void show(const ViewBound& bound) {
  fmt::print("  {:2.0f} % ", 100.0 * bound.share);
  if (!bound.reached) {
    fmt::print("not even with all poses together\n");
    return;
  }
  fmt::print("greedy {} views, {:.1f} m; no planner below {} views, {:.1f} m\n", bound.greedy_views,
             bound.greedy_m, bound.fewest_views, bound.shortest_m);
}

int bound(const nextview::RunOptions& options) {
  if (!options.resume.empty()) {
    throw nextview::SetupError("--resume is for nextview_run: name the scene of that run instead");
  }
  const nextview::RunSetup setup = nextview::prepare_run(options);
  nextview::note_signals();  // not before: until here a signal may end this at once
  const nextview::ViewBoundQuestion question = nextview::bound_question_of(options, setup.config);
  const std::string cache = nextview::cache_folder(options.cache);
  const std::string digest = nextview::mesh_digest(setup.scene->mesh());
  auto bounds = nextview::kept_view_bounds(cache, digest, question);
  if (!bounds) {
    Watch watch;
    bounds = nextview::view_bounds(cache, *setup.scene, digest, question, watch.stop(),
                                   &watch.progress());
    if (nextview::noted_signal() != 0) return 128 + nextview::noted_signal();
    if (!nextview::keep_view_bounds(cache, digest, question, *bounds)) {
      std::cerr << "nextview_bound: " << cache << " cannot be written to: see --cache" << std::endl;
    }
  }
  fmt::print("{}, positions {:.2f} m apart, 320 orientations\n", setup.config.scene_name,
             options.bound_spacing_m);
  for (const ViewBound& each : *bounds) show(each);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  nextview::answer_for_standard_output();
  int exit_status = 0;
  const auto options = nextview::parse_run_options(argc, argv, exit_status, kDescription);
  if (!options) return exit_status;
  try {
    return bound(*options);
  } catch (const std::exception& error) {
    std::cerr << "nextview_bound: " << error.what() << std::endl;
    return 1;
  }
}

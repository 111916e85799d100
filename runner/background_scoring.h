#pragma once

#include <chrono>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>

#include "scoring/visible_surface.h"

namespace nextview {

/// Works out beside a run what can be seen of its scene at all, in a thread that gives way to
/// everybody else. Nothing that goes wrong there touches the run: it is the reason why the coverage
/// stays unknown.
class BackgroundScoring {
 public:
  /// What is to be worked out; it may throw anything, and ends early when stop is requested.
  using Work = std::function<VisibleSurface(const std::stop_token& stop, VisibilityProgress*)>;

  explicit BackgroundScoring(Work work);

  /// Whether neither a surface nor a failure has been taken yet.
  bool pending() const { return coming_.valid(); }
  /// Waits for the end of the work, at most so long.
  /// @return the surface, once; nothing while it is being worked out, and when that has failed
  std::optional<VisibleSurface> take(std::chrono::milliseconds timeout);
  /// Why there will be no surface, once take() has seen that it failed; else empty.
  const std::string& failure() const { return failure_; }

  /// How much of the work is done, 0 to 100.
  int percent() const;
  /// Ends the work soon; what it would have found is lost.
  void request_stop() { thread_.request_stop(); }

 private:
  std::future<VisibleSurface> coming_;
  std::string failure_;
  std::shared_ptr<VisibilityProgress> progress_ = std::make_shared<VisibilityProgress>();
  std::jthread thread_;
};

}  // namespace nextview

#pragma once

#include <algorithm>
#include <chrono>
#include <exception>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>

#include "runner/give_way.h"
#include "scoring/visible_surface.h"

namespace nextview {

/// Works out beside a run something that it is scored by, such as what can be seen of its scene at
/// all, in a thread that gives way to everybody else. Nothing that goes wrong there touches the
/// run: it is the reason why the score stays unknown.
template <class Result>
class BackgroundScoring {
 public:
  /// What is to be worked out; it may throw anything, and ends early when stop is requested.
  using Work = std::function<Result(const std::stop_token& stop, WorkProgress*)>;

  explicit BackgroundScoring(Work work) {
    std::promise<Result> promise;
    coming_ = promise.get_future();
    thread_ = std::jthread([work = std::move(work), progress = progress_,
                            promise = std::move(promise)](const std::stop_token& stop) mutable {
      give_way();
      try {
        promise.set_value(work(stop, progress.get()));
      } catch (...) {
        promise.set_exception(std::current_exception());
      }
    });
  }

  /// Whether neither a result nor a failure has been taken yet.
  bool pending() const { return coming_.valid(); }
  /// Waits for the end of the work, at most so long.
  /// @return the result, once; nothing while it is being worked out, and when that has failed
  std::optional<Result> take(std::chrono::milliseconds timeout) {
    if (!pending() || coming_.wait_for(timeout) != std::future_status::ready) return std::nullopt;
    try {
      return coming_.get();
    } catch (const std::exception& error) {
      failure_ = std::string("it could not be worked out: ") + error.what();
    } catch (...) {
      failure_ = "it could not be worked out";
    }
    return std::nullopt;
  }
  /// Why there will be no result, once take() has seen that it failed; else empty.
  const std::string& failure() const { return failure_; }

  /// How much of the work is done, 0 to 100; 0 while it is not known how much there is.
  int percent() const {
    const std::int64_t of = progress_->of;
    return of > 0 ? static_cast<int>(100 * progress_->done / of) : 0;
  }
  /// Ends the work soon; what it would have found is lost.
  void request_stop() { thread_.request_stop(); }

 private:
  std::future<Result> coming_;
  std::string failure_;
  std::shared_ptr<WorkProgress> progress_ = std::make_shared<WorkProgress>();
  std::jthread thread_;
};

}  // namespace nextview

#include "runner/background_scoring.h"

#include <algorithm>
#include <exception>
#include <utility>

#include "runner/give_way.h"

namespace nextview {

BackgroundScoring::BackgroundScoring(Work work) {
  std::promise<VisibleSurface> promise;
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

std::optional<VisibleSurface> BackgroundScoring::take(std::chrono::milliseconds timeout) {
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

int BackgroundScoring::percent() const {
  const std::int64_t of = std::max<std::int64_t>(1, progress_->of);
  return static_cast<int>(100 * progress_->done / of);
}

}  // namespace nextview

#include "scoring/on_all_cores.h"

#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace nextview {

void on_all_cores(const std::function<void()>& work) {
  std::mutex failing;
  std::exception_ptr failure;
  const auto work_safely = [&] {
    try {
      work();
    } catch (...) {
      const std::lock_guard lock(failing);
      failure = std::current_exception();
    }
  };
  {
    std::vector<std::jthread> others;
    for (unsigned i = 1; i < std::thread::hardware_concurrency(); ++i) {
      others.emplace_back(work_safely);
    }
    work_safely();
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace nextview

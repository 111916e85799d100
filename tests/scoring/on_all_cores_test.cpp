#include "scoring/on_all_cores.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <thread>

namespace nextview {
namespace {

TEST(OnAllCores, TheWorkIsDoneOnceACore) {
  std::atomic<unsigned> done = 0;
  on_all_cores([&done] { ++done; });
  EXPECT_EQ(done, std::max(1U, std::thread::hardware_concurrency()));
}

TEST(OnAllCores, WhatOneThrowsComesOutAfterTheOthersAreDone) {
  std::atomic<unsigned> others = 0;
  std::atomic<bool> thrown = false;
  EXPECT_THROW(on_all_cores([&] {
                 if (!thrown.exchange(true)) throw std::runtime_error("this core is on fire");
                 ++others;
               }),
               std::runtime_error);
  EXPECT_EQ(others + 1, std::max(1U, std::thread::hardware_concurrency()));
}

}  // namespace
}  // namespace nextview

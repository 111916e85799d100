// Logs of which one thing was changed by chance. A replay notices, or says that it does not check
// it. nextview_mutations does the same many times, with the log of a whole run.

#include "tests/logger/log_mutations.h"

#include <gtest/gtest.h>

#include "logger/log_event.h"
#include "tests/logger/recorded_run.h"

namespace nextview {
namespace {

LogBytes bytes_of(const Recording& recording) {
  LogBytes log;
  std::uint64_t number = 0;
  for (const auto& [channel, data] : recording) {
    const auto received_us = static_cast<std::int64_t>(1000 * number);
    const LogBytes event =
        encode_event({.number = number++, .received_us = received_us}, channel, data);
    log.insert(log.end(), event.begin(), event.end());
  }
  return log;
}

/// The recording with a seal that knows when its events were received.
LogBytes sealed_bytes_of(const Recording& recording) {
  LogContents contents;
  std::uint64_t number = 0;
  std::int64_t received_us = 0;
  for (const auto& [channel, data] : recording) {
    received_us = static_cast<std::int64_t>(1000 * number);
    contents.add({channel, data, number++, received_us});
  }
  const stop_t stop = log_of(recording).record().stop().value();
  LogBytes log = bytes_of(recording);
  const LogBytes seal =
      encode_event({.number = number, .received_us = received_us}, Channel<seal_t>::name,
                   encode(contents.seal(stop.run, stop.utime)));
  log.insert(log.end(), seal.begin(), seal.end());
  return log;
}

void expect_noticed(const LogBytes& log, bool planner, std::uint64_t seeds) {
  for (int kind = 0; kind < kMutationKinds; ++kind) {
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
      const Mutation mutation = mutated(log, static_cast<MutationKind>(kind), seed);
      EXPECT_NE(notice_of(mutation, log, planner), Notice::Nothing)
          << to_string(mutation.kind) << ", " << mutation.what << (planner ? ", planner" : "");
    }
  }
}

TEST(LogMutations, AreTheSameForTheSameSeed) {
  const LogBytes log = bytes_of(record_run());
  for (int kind = 0; kind < kMutationKinds; ++kind) {
    const auto of = static_cast<MutationKind>(kind);
    EXPECT_EQ(mutated(log, of, 3).log, mutated(log, of, 3).log);
    EXPECT_NE(mutated(log, of, 3).log, log) << to_string(of);
  }
}

TEST(LogMutations, OfASealedLogAreNoticed) {
  const LogBytes log = sealed_bytes_of(record_run());
  expect_noticed(log, false, 40);
  expect_noticed(log, true, 10);
}

TEST(LogMutations, OfALogWithoutASealAreNoticedOrNamed) {
  const LogBytes log = bytes_of(record_run());
  expect_noticed(log, false, 40);
  expect_noticed(log, true, 10);
}

}  // namespace
}  // namespace nextview

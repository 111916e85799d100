#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace nextview {

/// A log as the bytes of its file.
using LogBytes = std::vector<std::uint8_t>;

/// What can become of a log.
enum class MutationKind {
  BitFlip,        ///< of any byte
  FieldChange,    ///< of a message of ours, the rest as it was
  Truncation,     ///< at any byte
  MissingEvent,   ///< the others as they were
  DoubledEvent,   ///< stands twice
  SwappedEvents,  ///< two neighbours
  ForeignEvent,   ///< on a channel of somebody else's, put in between
};
constexpr int kMutationKinds = 7;
std::string_view to_string(MutationKind kind);

/// A log of which one thing was changed.
struct Mutation {
  MutationKind kind = MutationKind::BitFlip;
  std::string what;  ///< in words, for people
  LogBytes log;
};

/// A log changed by chance: the same for the same log, kind and seed.
Mutation mutated(const LogBytes& log, MutationKind kind, std::uint64_t seed);

/// A whole log without its last event, which is the seal of one that has its seal.
LogBytes without_last_event(const LogBytes& log);

/// What a replay made of a mutation.
enum class Notice {
  Status,   ///< its exit status says that not all agrees
  Said,     ///< status 0, but what was changed is named: as unchecked, foreign, or told of
  Nothing,  ///< agreed to it without a word
};

/// Replays a log that was changed.
/// @param original what it was, which agrees
Notice notice_of(const Mutation& mutation, const LogBytes& original, bool planner);

}  // namespace nextview

#include "tests/logger/log_mutations.h"

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <random>
#include <span>

#include "lcmtypes/decode.h"
#include "logger/log_event.h"
#include "logger/message_fields.h"
#include "logger/replay.h"
#include "logger/unchecked_fields.h"
#include "tests/logger/change_value.h"

namespace nextview {
namespace {

using Random = std::mt19937_64;

struct Event {
  std::size_t start = 0;
  EventHeader header;
  std::string channel;

  std::size_t end() const { return start + header.event_bytes(); }
  std::size_t data() const { return start + kEventHeaderBytes + header.channel_bytes; }
};

std::span<const std::uint8_t> data_of(const Event& event, const LogBytes& log) {
  return std::span(log).subspan(event.data(), event.header.data_bytes);
}

/// Of a log that is whole.
std::vector<Event> events_of(const LogBytes& log) {
  std::vector<Event> events;
  for (std::size_t at = 0; at + kEventHeaderBytes <= log.size();) {
    const auto header = event_header(std::span(log).subspan(at, kEventHeaderBytes));
    if (!header || at + header->event_bytes() > log.size()) break;
    const auto name = log.begin() + static_cast<std::ptrdiff_t>(at + kEventHeaderBytes);
    events.push_back(
        {at, *header,
         std::string(name, name + static_cast<std::ptrdiff_t>(header->channel_bytes))});
    at += header->event_bytes();
  }
  return events;
}

/// The log with other bytes in the place of some.
LogBytes with_instead(const LogBytes& log, std::size_t from, std::size_t to,
                      const LogBytes& instead) {
  LogBytes changed(log.begin(), log.begin() + static_cast<std::ptrdiff_t>(from));
  changed.insert(changed.end(), instead.begin(), instead.end());
  changed.insert(changed.end(), log.begin() + static_cast<std::ptrdiff_t>(to), log.end());
  return changed;
}

LogBytes bytes_of(const LogBytes& log, std::size_t from, std::size_t to) {
  return {log.begin() + static_cast<std::ptrdiff_t>(from),
          log.begin() + static_cast<std::ptrdiff_t>(to)};
}

std::string name_of(const Event& event) {
  return "event " + std::to_string(event.header.number) + ", " + event.channel;
}

struct ChangedField {
  std::string field;
  LogBytes data;
};

/// A message with one of its fields changed: the first that can be, from the chosen one on.
template <class Message>
ChangedField with_changed_field(std::span<const std::uint8_t> data, Random& random) {
  const Message message = decode_checked<Message>(data).message.value();
  std::vector<ChangedField> possible;
  const Change by = random() % 2 == 0 ? Change::LastBit : Change::Much;
  for_each_field<Message>([&](const std::string& field, const auto& get) {
    Message other = message;
    if (!change(get(other), by)) return;
    // The length of an array that has no more than it says.
    if (std::is_integral_v<std::remove_cvref_t<decltype(get(other))>> &&
        other.getEncodedSize() > message.getEncodedSize()) {
      return;
    }
    possible.push_back({field, encode(other)});
  });
  return possible[random() % possible.size()];
}

Mutation change_field(const LogBytes& log, const std::vector<Event>& events, Random& random) {
  std::vector<const Event*> ours;
  // By channel first: there are few configurations and many timings.
  std::vector<std::string> channels;
  for_each_channel([&]<class Message>() {
    const std::string name(Channel<Message>::name);
    if (std::any_of(events.begin(), events.end(),
                    [&](const Event& event) { return event.channel == name; })) {
      channels.push_back(name);
    }
  });
  const std::string channel = channels[random() % channels.size()];
  for (const Event& event : events) {
    if (event.channel == channel) ours.push_back(&event);
  }
  const Event& event = *ours[random() % ours.size()];
  Mutation mutation;
  for_each_channel([&]<class Message>() {
    if (Channel<Message>::name != channel) return;
    const ChangedField changed = with_changed_field<Message>(data_of(event, log), random);
    mutation.what = name_of(event) + ": " + changed.field;
    mutation.log = with_instead(log, event.start, event.end(),
                                encode_event(event.header, channel, changed.data));
  });
  return mutation;
}

Mutation flip_bit(const LogBytes& log, Random& random) {
  const std::size_t bit = random() % (8 * log.size());
  Mutation mutation{.what = "bit " + std::to_string(bit), .log = log};
  mutation.log[bit / 8] ^= static_cast<std::uint8_t>(1U << bit % 8);
  return mutation;
}

Mutation cut_off(const LogBytes& log, Random& random) {
  const std::size_t bytes = random() % log.size();
  return {.what = "after byte " + std::to_string(bytes), .log = bytes_of(log, 0, bytes)};
}

Mutation swap_events(const LogBytes& log, const Event& first, const Event& second) {
  LogBytes swapped = bytes_of(log, second.start, second.end());
  const LogBytes other = bytes_of(log, first.start, first.end());
  swapped.insert(swapped.end(), other.begin(), other.end());
  return {.what = name_of(first) + ", and " + name_of(second),
          .log = with_instead(log, first.start, second.end(), swapped)};
}

Mutation put_foreign_event_before(const LogBytes& log, const Event& event, Random& random) {
  LogBytes data(random() % 200);
  for (std::uint8_t& byte : data) byte = static_cast<std::uint8_t>(random());
  return {.what = "before " + name_of(event),
          .log = with_instead(log, event.start, event.start,
                              encode_event(event.header, "SOMEBODY_ELSE", data))};
}

Mutation mutation_of(const LogBytes& log, MutationKind kind, Random& random) {
  const std::vector<Event> events = events_of(log);
  const std::size_t i = random() % (events.size() - 1);
  const Event& event = events[i];
  switch (kind) {
    case MutationKind::BitFlip:
      return flip_bit(log, random);
    case MutationKind::FieldChange:
      return change_field(log, events, random);
    case MutationKind::Truncation:
      return cut_off(log, random);
    case MutationKind::MissingEvent:
      return {.what = name_of(event), .log = with_instead(log, event.start, event.end(), {})};
    case MutationKind::DoubledEvent:
      return {.what = name_of(event),
              .log = with_instead(log, event.end(), event.end(),
                                  bytes_of(log, event.start, event.end()))};
    case MutationKind::SwappedEvents:
      return swap_events(log, event, events[i + 1]);
    case MutationKind::ForeignEvent:
      return put_foreign_event_before(log, event, random);
  }
  return {};
}

/// A log in a file of its own while it is read.
RunLog read_log(const LogBytes& bytes) {
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() /
      ("nextview-mutation-" + std::to_string(::getpid()) + ".lcmlog");
  std::ofstream(file, std::ios::binary | std::ios::trunc)
      .write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
  RunLog log(file, std::nullopt, RangeImages::Keep);
  std::filesystem::remove(file);
  log.read_on();
  return log;
}

/// Whether the two logs differ in nothing but what is listed as unchecked.
bool differ_in_unchecked_fields_only(const LogBytes& a, const LogBytes& b,
                                     const std::vector<UncheckedFields>& unchecked) {
  const std::vector<Event> events = events_of(a);
  const std::vector<Event> others = events_of(b);
  if (events.size() != others.size()) return false;
  bool only = true;
  for (std::size_t i = 0; i < events.size(); ++i) {
    // Of an event's header only when it was received is not checked.
    if (events[i].header.number != others[i].header.number) return false;
    if (events[i].channel == others[i].channel &&
        std::ranges::equal(data_of(events[i], a), data_of(others[i], b))) {
      continue;
    }
    bool named = false;
    for_each_channel([&]<class Message>() {
      if (events[i].channel != Channel<Message>::name || others[i].channel != events[i].channel) {
        return;
      }
      const auto one = decode_checked<Message>(data_of(events[i], a)).message;
      const auto other = decode_checked<Message>(data_of(others[i], b)).message;
      if (!one || !other) return;
      const auto fields = differing_fields(*one, *other);
      named = !fields.empty() && std::all_of(fields.begin(), fields.end(), [&](const auto& field) {
        return is_unchecked(unchecked, Channel<Message>::name, field);
      });
    });
    only &= named;
  }
  return only;
}

}  // namespace

std::string_view to_string(MutationKind kind) {
  switch (kind) {
    case MutationKind::BitFlip:
      return "a bit flipped";
    case MutationKind::FieldChange:
      return "a field changed";
    case MutationKind::Truncation:
      return "cut off";
    case MutationKind::MissingEvent:
      return "an event taken out";
    case MutationKind::DoubledEvent:
      return "an event doubled";
    case MutationKind::SwappedEvents:
      return "two events swapped";
    case MutationKind::ForeignEvent:
      return "a foreign event put in";
  }
  return "";
}

Mutation mutated(const LogBytes& log, MutationKind kind, std::uint64_t seed) {
  Random random(seed * kMutationKinds + static_cast<std::uint64_t>(kind));
  Mutation mutation = mutation_of(log, kind, random);
  mutation.kind = kind;
  return mutation;
}

LogBytes without_last_event(const LogBytes& log) {
  const std::vector<Event> events = events_of(log);
  return events.empty() ? log : bytes_of(log, 0, events.back().start);
}

Notice notice_of(const Mutation& mutation, const LogBytes& original, bool planner) {
  const RunLog log = read_log(mutation.log);
  const ReplayReport report = replay(log, {.planner = planner});
  if (report.exit_status() != 0) return Notice::Status;
  if (!report.remarks.empty() || !log.dropped().empty()) return Notice::Said;
  const auto unchecked = unchecked_fields(log.record(), planner);
  if (report.sealed) return Notice::Nothing;
  const bool named = differ_in_unchecked_fields_only(mutation.log, original, unchecked);
  return named ? Notice::Said : Notice::Nothing;
}

}  // namespace nextview

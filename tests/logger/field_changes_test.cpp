// Changes every field of every type of message of a recorded run, one at a time. A replay notices,
// or says by itself that it does not check that field.

#include <gtest/gtest.h>

#include <fstream>
#include <iostream>
#include <iterator>
#include <regex>
#include <set>
#include <sstream>

#include "logger/message_fields.h"
#include "logger/replay.h"
#include "logger/unchecked_fields.h"
#include "tests/logger/change_value.h"
#include "tests/logger/recorded_run.h"

namespace nextview {
namespace {

/// Of the two attempts at view 3, the one that was refused and the one that was not.
constexpr int kView = 3;

template <class Message>
bool is_to_be_changed(const Message& message) {
  if constexpr (Channel<Message>::answered && requires { message.view; }) {
    return message.view == kView;
  }
  return true;
}

struct Tally {
  int noticed = 0;
  int taken_as_is = 0;
  std::set<std::string> fields_taken_as_they_are;  ///< with their channel
};

/// Changes a field of each message in turn.
template <class Message, class Get>
void change_field(const Recording& recording, const std::string& field, const Get& get,
                  bool planner, Tally& tally) {
  const auto unchecked = unchecked_fields(log_of(recording).record(), planner);
  const bool is_config = std::is_same_v<Message, run_config_t>;
  for (std::size_t i = 0; i < recording.size(); ++i) {
    if (recording[i].first != Channel<Message>::name) continue;
    Message message = *decode_checked<Message>(recording[i].second).message;
    if (!is_to_be_changed(message)) continue;
    if (!change(get(message), is_config ? Change::Much : Change::LastBit)) continue;
    Recording tampered = recording;
    tampered[i].second = encode(message);
    if (replay(log_of(tampered), {.planner = planner}).exit_status() != 0) {
      ++tally.noticed;
    } else {
      ++tally.taken_as_is;
      tally.fields_taken_as_they_are.insert(std::string(Channel<Message>::name) + " " + field);
      EXPECT_TRUE(is_unchecked(unchecked, Channel<Message>::name, field))
          << Channel<Message>::name << " " << field << (planner ? " with" : " without")
          << " the planner, message " << i;
    }
  }
}

/// Whether a field is the length of an array, which only changes with the array.
template <class Message>
bool is_length(const std::string& field) {
  std::ifstream in(NEXTVIEW_SOURCE_DIR "/lcmtypes/nextview_" + std::string(Message::getTypeName()) +
                   ".lcm");
  const std::string text((std::istreambuf_iterator<char>(in)), {});
  return text.find("[" + field + "]") != std::string::npos;
}

/// Whether some message with another value of a field passes as right.
template <class Message, class Get>
bool some_change_is_taken(const Recording& recording, const Get& get, bool planner) {
  for (std::size_t i = 0; i < recording.size(); ++i) {
    if (recording[i].first != Channel<Message>::name) continue;
    const Message message = *decode_checked<Message>(recording[i].second).message;
    if (!is_to_be_changed(message)) continue;
    for (int which = 0;; ++which) {
      Message other = message;
      if (!set_other(get(other), which)) break;
      Recording tampered = recording;
      tampered[i].second = encode(other);
      if (tampered[i].second == recording[i].second) continue;
      if (replay(log_of(tampered), {.planner = planner}).exit_status() == 0) return true;
    }
  }
  return false;
}

/// No field is among the unchecked ones of which every change is noticed.
void expect_listed_fields_taken_as_they_are(const Recording& recording, bool planner,
                                            const std::set<std::string>& taken) {
  const RunLog log = log_of(recording);
  auto unchecked = unchecked_fields(log.record(), planner);
  // Of these it is for the run to say whether something depends on them.
  std::erase_if(unchecked, [](const UncheckedFields& some) {
    return some.why == "shows only where a decision depends on it";
  });
  for_each_channel([&]<class Message>() {
    for_each_field<Message>([&](const std::string& field, const auto& get) {
      const std::string_view channel = Channel<Message>::name;
      if (!is_unchecked(unchecked, channel, field) || is_length<Message>(field) ||
          taken.contains(std::string(channel) + " " + field)) {
        return;
      }
      EXPECT_TRUE(some_change_is_taken<Message>(recording, get, planner))
          << channel << " " << field << (planner ? " with" : " without")
          << " the planner: listed as unchecked, but a change of it is noticed";
    });
  });
}

void expect_changes_noticed_or_said_to_be_unchecked(const Recording& recording) {
  for (const bool planner : {false, true}) {
    ASSERT_EQ(replay(log_of(recording), {.planner = planner}).exit_status(), 0);
    std::set<std::string> taken;
    for_each_channel([&]<class Message>() {
      if (std::is_same_v<Message, seal_t>) return;  // a recorder writes none
      Tally tally;
      for_each_field<Message>([&](const std::string& field, const auto& get) {
        change_field<Message>(recording, field, get, planner, tally);
      });
      EXPECT_GT(tally.noticed + tally.taken_as_is, 0) << Channel<Message>::name;
      std::cout << Channel<Message>::name << (planner ? ", planner: " : ": ") << tally.noticed
                << " changes noticed, " << tally.taken_as_is << " said to be unchecked\n";
      taken.merge(tally.fields_taken_as_they_are);
    });
    expect_listed_fields_taken_as_they_are(recording, planner, taken);
  }
}

TEST(FieldChanges, OfASealedLogAreAllNoticed) {
  const Recording recording = sealed(record_run());
  ASSERT_EQ(replay(log_of(recording), {}).exit_status(), 0);
  int changes = 0;
  for_each_channel([&]<class Message>() {
    for_each_field<Message>([&](const std::string& field, const auto& get) {
      for (std::size_t i = 0; i < recording.size(); ++i) {
        if (recording[i].first != Channel<Message>::name) continue;
        Message message = *decode_checked<Message>(recording[i].second).message;
        if (!is_to_be_changed(message) || !change(get(message), Change::LastBit)) continue;
        Recording tampered = recording;
        tampered[i].second = encode(message);
        const ReplayReport report = replay(log_of(tampered), {});
        const bool said = report.exit_status() != 0 || !report.sealed || !report.remarks.empty();
        EXPECT_TRUE(said) << Channel<Message>::name << " " << field << ", message " << i;
        ++changes;
        if (!Channel<Message>::answered) break;  // they are alike, and many
      }
    });
  });
  EXPECT_GT(changes, 200);
}

TEST(FieldChanges, AreNoticedOrSaidToBeUnchecked) {
  expect_changes_noticed_or_said_to_be_unchecked(record_run());
}

TEST(FieldChanges, InARunOfADriversAreNoticedOrSaidToBeUnchecked) {
  const Recording own_base = with_driver_for("base_sim", record_run());
  expect_changes_noticed_or_said_to_be_unchecked(own_base);
  expect_changes_noticed_or_said_to_be_unchecked(with_driver_for("sensor_sim", own_base));
}

void expect_that_unchecked_fields_exist(const Recording& recording) {
  const RunLog log = log_of(recording);
  for (const UncheckedFields& some : unchecked_fields(log.record(), false)) {
    for (const std::string& name : some.fields) {
      bool exists = false;
      for_each_channel([&]<class Message>() {
        if (some.channel != Channel<Message>::name) return;
        for_each_field<Message>(
            [&](const std::string& field, const auto&) { exists |= field == name; });
      });
      EXPECT_TRUE(exists) << some.channel << " has no field " << name;
    }
  }
}

TEST(FieldChanges, UncheckedFieldsExist) {
  const Recording own_base = with_driver_for("base_sim", record_run());
  for (const Recording& recording :
       {record_run(), own_base, with_driver_for("sensor_sim", own_base)}) {
    expect_that_unchecked_fields_exist(recording);
  }
}

std::vector<std::string> fields_in_file(const std::string& type) {
  const std::string file = NEXTVIEW_SOURCE_DIR "/lcmtypes/nextview_" + type + ".lcm";
  std::ifstream in(file);
  std::vector<std::string> names;
  const std::regex field(R"(^\s+\w+\s+(\w+)\s*(\[[^;]*)?;.*)");
  std::smatch match;
  for (std::string line; std::getline(in, line);) {
    if (std::regex_match(line, match, field)) names.push_back(match[1]);
  }
  EXPECT_FALSE(names.empty()) << file;
  return names;
}

template <class Message>
void expect_fields_of_file(const std::string& type) {
  std::vector<std::string> names;
  std::apply([&](const auto&... field) { (names.emplace_back(field.name), ...); },
             MessageFields<Message>::list);
  EXPECT_EQ(names, fields_in_file(type)) << type;
}

TEST(MessageFields, AreThoseOfTheFiles) {
  for_each_channel([]<class Message>() { expect_fields_of_file<Message>(Message::getTypeName()); });
  expect_fields_of_file<scene_config_t>("scene_config_t");
  expect_fields_of_file<sensor_config_t>("sensor_config_t");
  expect_fields_of_file<base_config_t>("base_config_t");
  expect_fields_of_file<map_config_t>("map_config_t");
  expect_fields_of_file<planner_config_t>("planner_config_t");
}

}  // namespace
}  // namespace nextview

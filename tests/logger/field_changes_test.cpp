// Changes every field of every type of message of a recorded run, one at a time. A replay notices,
// or says by itself that it does not check that field.

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iostream>
#include <limits>
#include <regex>
#include <sstream>

#include "logger/message_fields.h"
#include "logger/replay.h"
#include "logger/unchecked_fields.h"
#include "tests/logger/recorded_run.h"

namespace nextview {
namespace {

/// Of the two attempts at view 3, the one that was refused and the one that was not.
constexpr int kView = 3;

/// By how much a number is changed: its last bit, or enough to matter to what depends on it.
enum class Change { LastBit, Much };

/// Makes a value another one, an array by its last element; false for an empty one. Integers get
/// smaller where they can, so that one that is an array's length stays within the array.
template <class Value>
bool change(Value& value, Change by) {
  if constexpr (std::is_floating_point_v<Value>) {
    if (!std::isfinite(value)) {
      value = 1;
    } else if (by == Change::Much) {
      value = value * Value(1.01) + Value(0.01);
    } else {
      value = std::nextafter(value, value > 0 ? Value(0) : std::numeric_limits<Value>::max());
    }
    return true;
  } else if constexpr (std::is_integral_v<Value>) {
    value = static_cast<Value>(value > 0 ? value - 1 : value + 1);
    return true;
  } else if constexpr (std::is_same_v<Value, std::string>) {
    if (value.empty()) {
      value = "x";
    } else {
      value.back() = value.back() == '1' ? '2' : '1';
    }
    return true;
  } else {
    return std::size(value) > 0 && change(value[std::size(value) - 1], by);
  }
}

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
      EXPECT_TRUE(is_unchecked(unchecked, Channel<Message>::name, field))
          << Channel<Message>::name << " " << field << (planner ? " with" : " without")
          << " the planner, message " << i;
    }
  }
}

void expect_changes_noticed_or_said_to_be_unchecked(const Recording& recording) {
  for (const bool planner : {false, true}) {
    ASSERT_EQ(replay(log_of(recording), {.planner = planner}).exit_status(), 0);
    for_each_channel([&]<class Message>() {
      Tally tally;
      for_each_field<Message>([&](const std::string& field, const auto& get) {
        change_field<Message>(recording, field, get, planner, tally);
      });
      EXPECT_GT(tally.noticed + tally.taken_as_is, 0) << Channel<Message>::name;
      std::cout << Channel<Message>::name << (planner ? ", planner: " : ": ") << tally.noticed
                << " changes noticed, " << tally.taken_as_is << " said to be unchecked\n";
    });
  }
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
      bool exists = name == "*";
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

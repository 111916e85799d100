#include "runner/bound_command.h"

#include <filesystem>
#include <set>

namespace nextview {
namespace {

/// Options of what a run leaves and shows, which the bounds have nothing to do with.
const std::set<std::string> kOfTheRunAlone = {
    "--view", "--paused", "--private", "--no-private", "--real-time", "--verbose", "--no-coverage"};
/// Such as a value follows.
const std::set<std::string> kOfTheRunAloneWithValue = {"--out", "--runs", "--key-file", "--lcm-url",
                                                       "--patience"};

}  // namespace

std::string bound_command_for(int argc, char** argv) {
  const auto quoted = [](const std::string& argument) {
    constexpr const char* kPlain =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=.,:/@%";
    if (!argument.empty() && argument.find_first_not_of(kPlain) == std::string::npos) {
      return argument;
    }
    std::string text(1, '\'');
    for (const char character : argument) {
      text += character == '\'' ? std::string("'\\''") : std::string(1, character);
    }
    text += '\'';
    return text;
  };
  std::string command =
      quoted((std::filesystem::path(argv[0]).parent_path() / "nextview_bound").string());
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    const std::string name = argument.substr(0, argument.find('='));
    if (kOfTheRunAlone.contains(name)) continue;
    if (kOfTheRunAloneWithValue.contains(name)) {
      if (name == argument) ++i;
      continue;
    }
    command += ' ';
    command += quoted(argument);
  }
  return command;
}

}  // namespace nextview

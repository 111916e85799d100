#pragma once

#include <CLI/App.hpp>
#include <string>

namespace nextview {

/// The long name, without its dashes, of the program's option that is nearest to what was typed:
/// the one that fewest letters have to be changed, put in or taken out for.
/// @param otherwise taken when no option is nearer than it
std::string nearest_option(const CLI::App& app, const std::string& typed, std::string otherwise);

/// What CLI11 says of a wrong command line, and which options may have been meant. For
/// CLI::App::failure_message, of every program.
std::string what_is_wrong(const CLI::App* app, const CLI::Error& error);

}  // namespace nextview

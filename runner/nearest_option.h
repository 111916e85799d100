#pragma once

#include <CLI/App.hpp>
#include <string>

namespace nextview {

/// The long name, without its dashes, of the program's option that is nearest to what was typed:
/// the one that fewest letters have to be changed, put in or taken out for.
/// @param otherwise taken when no option is nearer than it
std::string nearest_option(const CLI::App& app, const std::string& typed, std::string otherwise);

}  // namespace nextview

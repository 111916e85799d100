#include "lcmtypes/nearest_option.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

namespace nextview {
namespace {

// Levenshtein's distance: how many letters are to be changed, put in or taken out.
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t before = std::exchange(row[0], i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = before + (a[i - 1] == b[j - 1] ? 0 : 1);
      before = row[j];
      row[j] = std::min({replaced, before + 1, row[j - 1] + 1});
    }
  }
  return row.back();
}

}  // namespace

std::string nearest_option(const CLI::App& app, const std::string& typed, std::string otherwise) {
  std::string nearest = std::move(otherwise);
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& other : option->get_lnames()) {
      if (edit_distance(typed, other) < edit_distance(typed, nearest)) nearest = other;
    }
  }
  return nearest;
}

std::string what_is_wrong(const CLI::App* app, const CLI::Error& error) {
  std::string text = CLI::FailureMessage::simple(app, error);
  for (const std::string& typed : app->remaining()) {
    if (!typed.starts_with("--")) continue;
    const std::string name = typed.substr(2, typed.find('=') - 2);
    text += fmt::format("No option --{}; did you mean --{}?\n", name,
                        nearest_option(*app, name, "help"));
  }
  return text;
}

}  // namespace nextview

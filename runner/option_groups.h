#pragma once

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <string>

#include "planner/strategy_facts.h"
#include "runner/run_options.h"

namespace nextview {

/// The command line of a run in its groups, as --help shows them. Each adds the options of one role
/// to a command line, which write what they are given to `options`; both must outlive the parsing.
void add_scene_options(CLI::App& app, RunOptions& options);
void add_run_options(CLI::App& app, RunOptions& options);
void add_sensor_options(CLI::App& app, RunOptions& options);
void add_base_options(CLI::App& app, RunOptions& options);
void add_map_options(CLI::App& app, RunOptions& options);
void add_planner_options(CLI::App& app, RunOptions& options);

/// Accepts what a parameter may be; CLI::Range would let NaN through.
CLI::Validator number_within(const Bounds& bounds);

/// "paper: this; surface: that", for a help text.
template <class Words>
std::string of_strategies(Words words) {
  std::string all;
  for (const StrategyFacts& strategy : all_strategies()) {
    all += fmt::format("{}{}: {}", all.empty() ? "" : "; ", strategy.name, words(strategy));
  }
  return all;
}

}  // namespace nextview

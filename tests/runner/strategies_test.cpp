// One list of strategies: what it names, options, help, checks of messages and the planner know,
// and nothing else.
#include <gtest/gtest.h>

#include <string>
#include <variant>
#include <vector>

#include "lcmtypes/validate.h"
#include "planner/planner_config.h"
#include "planner/strategy_facts.h"
#include "runner/run_options.h"
#include "runner/run_setup.h"
#include "sensor/sensor_config.h"
#include "sensor_sim/scan.h"

namespace nextview {
namespace {

/// Options as typed, and what was printed.
struct Parsed {
  std::optional<RunOptions> options;
  int status = 0;
  std::string printed;
};

Parsed parsed(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "nextview_run");
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  Parsed result;
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  result.options = parse_run_options(static_cast<int>(argv.size()), argv.data(), result.status, "");
  result.printed = testing::internal::GetCapturedStdout() + testing::internal::GetCapturedStderr();
  return result;
}

RunSetup setup_of(const StrategyFacts& strategy, std::vector<std::string> more = {}) {
  std::vector<std::string> arguments = {"boxes", "--strategy", std::string(strategy.name)};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return prepare_run(parsed(arguments).options.value());
}

/// Without line breaks and the blanks about them.
std::string in_one_line(const std::string& text) {
  std::string line;
  for (const char c : text) {
    const char blank = c == '\n' ? ' ' : c;
    if (blank != ' ' || line.empty() || line.back() != ' ') line += blank;
  }
  return line;
}

TEST(Strategies, AreMoreThanOneAndNamedAsOptionsAre) {
  EXPECT_GE(all_strategies().size(), 2U);
  for (const StrategyFacts& strategy : all_strategies()) {
    EXPECT_EQ(strategy.name.find_first_not_of("abcdefghijklmnopqrstuvwxyz_"), std::string::npos);
    EXPECT_EQ(find_strategy(strategy.name), &strategy) << "two of one name";
  }
}

TEST(Strategies, AreTakenByOptionsMessagesAndPlannerAlike) {
  for (const StrategyFacts& strategy : all_strategies()) {
    SCOPED_TRACE(strategy.name);
    const RunSetup setup = setup_of(strategy);
    EXPECT_EQ(check(setup.config), "");
    EXPECT_EQ(setup.config.strategy, strategy.name);
    EXPECT_EQ(setup.config.planner.max_views, strategy.views);
    EXPECT_EQ(setup.config.planner.directions, strategy.directions);
    EXPECT_EQ(setup_of(strategy, {"--quality"}).config.planner.max_views,
              strategy.views_with_quality);
    EXPECT_EQ(setup_of(strategy, {"--views", "7"}).config.planner.max_views, 7);

    const std::unique_ptr<ViewPlanner> planner = make_view_planner(setup.config);
    RandomStream no_noise(1, 1, 1, RandomPurpose::RangeNoise);
    planner->fold(scan(*setup.scene, make_ray_table(sensor_of(setup.config)),
                       range_limits_of(setup.config), start_pose_of(setup.config), 0.0, no_noise));
    const NextView& next = planner->next_view();
    ASSERT_TRUE(std::holds_alternative<Decision>(next));
    EXPECT_EQ(std::get<Decision>(next).strategy, strategy.name);
  }
}

TEST(Strategies, AreAllNamedWhereThereIsNone) {
  run_config_t config = setup_of(all_strategies().front()).config;
  config.strategy = "guess";
  RunOptions options = parsed({}).options.value();
  options.strategy = "guess";
  const Parsed typed = parsed({"--strategy", "guess"});
  EXPECT_FALSE(typed.options);
  EXPECT_GT(typed.status, 100);
  std::string planner;
  try {
    make_view_planner(config);
  } catch (const std::invalid_argument& error) {
    planner = error.what();
  }
  EXPECT_THROW(prepare_run(options), SetupError);
  for (const std::string& said : {typed.printed, check(config), planner}) {
    EXPECT_NE(said.find("'guess'"), std::string::npos) << said;
    for (const StrategyFacts& strategy : all_strategies()) {
      EXPECT_NE(said.find(strategy.name), std::string::npos) << said;
    }
  }
  EXPECT_NE(typed.printed.find("--strategy"), std::string::npos) << typed.printed;
}

TEST(Strategies, SayInHelpWhatTheyDoAndBring) {
  const Parsed help = parsed({"--help"});
  EXPECT_EQ(help.status, 0);
  const std::string text = in_one_line(help.printed);
  for (const StrategyFacts& strategy : all_strategies()) {
    const std::string name(strategy.name);
    for (const std::string& said :
         {name + ": " + std::string(strategy.summary), name + ": " + std::to_string(strategy.views),
          name + ": " + std::to_string(strategy.directions)}) {
      EXPECT_NE(text.find(said), std::string::npos) << said << "\nin\n" << text;
    }
  }
}

// No view shows less than nothing: such a run would never end.
TEST(Strategies, ThatEndByTheLeastGainHaveOne) {
  for (const StrategyFacts& strategy : all_strategies()) {
    run_config_t config = setup_of(strategy).config;
    config.planner.least_gain_m2 = 0.0;
    EXPECT_EQ(check(config).empty(), !strategy.ends_by_least_gain) << strategy.name;
  }
}

}  // namespace
}  // namespace nextview

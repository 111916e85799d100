#include "planner/termination.h"

#include <gtest/gtest.h>

#include <set>
#include <stdexcept>

namespace nextview {
namespace {

// Views that each cover some area, at some least quality.
std::vector<ViewFacts> views(std::size_t count, double area_m2, double min_quality = 0.0) {
  return std::vector<ViewFacts>(count, ViewFacts{area_m2, min_quality, min_quality});
}

StopParameters window_of_three() {
  StopParameters parameters;
  parameters.stop_window_views = 3;
  parameters.stop_new_area_m2 = 0.1;
  return parameters;
}

TEST(Termination, GoesOnWhileThereIsNewArea) {
  EXPECT_EQ(should_stop(views(9, 0.05), window_of_three()), std::nullopt);
}

TEST(Termination, Rule1EndsWhenTheWindowBringsLessThanTheArea) {
  auto history = views(2, 5.0);
  for (int quiet = 1; quiet <= 3; ++quiet) {
    EXPECT_EQ(should_stop(history, window_of_three()), std::nullopt) << quiet;
    history.push_back({0.03, 0.0, 0.0});
  }
  EXPECT_EQ(should_stop(history, window_of_three()), StopReason::NothingNew);
}

TEST(Termination, ExactlyTheAreaIsStillSomethingNew) {
  auto history = views(2, 5.0);
  history.insert(history.end(), {{0.1, 0.0, 0.0}, {0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}});
  EXPECT_EQ(should_stop(history, window_of_three()), std::nullopt);
}

TEST(Termination, NeedsAWholeWindowAfterTheFirstView) {
  EXPECT_EQ(should_stop(views(3, 0.0), window_of_three()), std::nullopt);
  EXPECT_EQ(should_stop(views(4, 0.0), window_of_three()), StopReason::NothingNew);
}

TEST(Termination, Rule2AlsoNeedsEveryVoxelsQuality) {
  StopParameters parameters = window_of_three();
  parameters.rule = StopRule::Quality;
  EXPECT_EQ(should_stop(views(5, 0.0, 0.79), parameters), std::nullopt);
  EXPECT_EQ(should_stop(views(5, 0.0, 0.80), parameters), StopReason::QualityReached);
  EXPECT_EQ(should_stop(views(5, 1.0, 0.80), parameters), std::nullopt);
}

// Views of nothing new after each of which the mean quality is as said.
std::vector<ViewFacts> qualities(std::initializer_list<double> means) {
  std::vector<ViewFacts> history;
  for (const double mean : means) history.push_back({0.0, 0.1, mean});
  return history;
}

TEST(Termination, Rule3EndsWhenQualityImprovesNoMore) {
  StopParameters parameters = window_of_three();
  parameters.rule = StopRule::NoImprovement;
  parameters.stop_improvement = 0.01;
  // Over the last three views, from 0.70: by 0.02, by 0.009, and when it falls.
  EXPECT_EQ(should_stop(qualities({0.5, 0.70, 0.70, 0.71, 0.72}), parameters), std::nullopt);
  EXPECT_EQ(should_stop(qualities({0.5, 0.70, 0.75, 0.71, 0.709}), parameters),
            StopReason::NoImprovement);
  EXPECT_EQ(should_stop(qualities({0.5, 0.70, 0.70, 0.70, 0.69}), parameters),
            StopReason::NoImprovement);
}

TEST(Termination, Rule3AlsoNeedsThatNothingNewIsCovered) {
  StopParameters parameters = window_of_three();
  parameters.rule = StopRule::NoImprovement;
  EXPECT_EQ(should_stop(views(9, 0.05, 0.9), parameters), std::nullopt);
  EXPECT_EQ(should_stop(views(3, 0.0, 0.9), parameters), std::nullopt) << "no whole window yet";
  EXPECT_EQ(should_stop(views(4, 0.0, 0.9), parameters), StopReason::NoImprovement);
}

TEST(Termination, FactsAreInSquareMetres) {
  FoldReport report;
  report.newly_occupied = 10;
  MapStatistics statistics;
  statistics.min_quality = 0.5;
  statistics.mean_quality = 0.7;
  const ViewFacts facts = view_facts(report, statistics, 0.1);
  EXPECT_NEAR(facts.newly_occupied_area_m2, 0.1, 1e-12);
  EXPECT_EQ(facts.min_quality, 0.5);
  EXPECT_EQ(facts.mean_quality, 0.7);
}

TEST(StopRules, RoundTripThroughTheirNamesAndHaveThePapersNumbers) {
  int number = 0;
  for (const StopRule rule : all_stop_rules()) {
    EXPECT_EQ(stop_rule_from_string(to_string(rule)), rule);
    EXPECT_EQ(static_cast<int>(rule), ++number);
  }
  EXPECT_EQ(number, 3);
  EXPECT_EQ(stop_rule_from_string("boredom"), std::nullopt);
}

TEST(Termination, ParametersThatCannotBeAreNamed) {
  const auto message = [](auto change) {
    StopParameters parameters;
    change(parameters);
    try {
      parameters.check();
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  using P = StopParameters;
  EXPECT_EQ(message([](P&) {}), "accepted");
  EXPECT_EQ(message([](P& p) { p.quality_threshold = 1.1; }),
            "quality_threshold = 1.1 is not a number from 0 to 1");
  EXPECT_EQ(message([](P& p) { p.stop_window_views = 0; }),
            "stop_window_views = 0 is not a number from 1 to 1e+06");
  EXPECT_EQ(message([](P& p) { p.stop_new_area_m2 = -1.0; }),
            "stop_new_area_m2 = -1 is not a number from 0 to 1e+06");
  EXPECT_EQ(message([](P& p) { p.stop_improvement = 2.0; }),
            "stop_improvement = 2 is not a number from 0 to 1");
  EXPECT_EQ(message([](P& p) { p.rule = StopRule{4}; }), "not a stop rule");
}

TEST(StopReasons, RoundTripThroughTheirNames) {
  std::set<std::string_view> names;
  for (const StopReason reason : all_stop_reasons()) {
    EXPECT_EQ(stop_reason_from_string(to_string(reason)), reason);
    EXPECT_FALSE(describe(reason).empty());
    names.insert(to_string(reason));
  }
  EXPECT_EQ(names.size(), 11u);
  EXPECT_EQ(stop_reason_from_string("bored"), std::nullopt);
}

}  // namespace
}  // namespace nextview

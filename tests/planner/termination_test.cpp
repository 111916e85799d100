#include "planner/termination.h"

#include <gtest/gtest.h>

#include <set>
#include <stdexcept>

namespace nextview {
namespace {

// Views that each cover some area, at some least quality.
std::vector<ViewFacts> views(std::size_t count, double area_m2, double min_quality = 0.0) {
  return std::vector<ViewFacts>(count, ViewFacts{area_m2, min_quality});
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
    history.push_back({0.03, 0.0});
  }
  EXPECT_EQ(should_stop(history, window_of_three()), StopReason::NothingNew);
}

TEST(Termination, ExactlyTheAreaIsStillSomethingNew) {
  auto history = views(2, 5.0);
  history.insert(history.end(), {{0.1, 0.0}, {0.0, 0.0}, {0.0, 0.0}});
  EXPECT_EQ(should_stop(history, window_of_three()), std::nullopt);
}

TEST(Termination, NeedsAWholeWindowAfterTheFirstView) {
  EXPECT_EQ(should_stop(views(3, 0.0), window_of_three()), std::nullopt);
  EXPECT_EQ(should_stop(views(4, 0.0), window_of_three()), StopReason::NothingNew);
}

TEST(Termination, Rule2AlsoNeedsEveryVoxelsQuality) {
  StopParameters parameters = window_of_three();
  parameters.use_quality = true;
  EXPECT_EQ(should_stop(views(5, 0.0, 0.79), parameters), std::nullopt);
  EXPECT_EQ(should_stop(views(5, 0.0, 0.80), parameters), StopReason::QualityReached);
  EXPECT_EQ(should_stop(views(5, 1.0, 0.80), parameters), std::nullopt);
}

TEST(Termination, FactsAreInSquareMetres) {
  EXPECT_NEAR(view_facts(10, 0.1, 0.5).newly_occupied_area_m2, 0.1, 1e-12);
  EXPECT_EQ(view_facts(10, 0.1, 0.5).min_quality, 0.5);
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
}

TEST(StopReasons, RoundTripThroughTheirNames) {
  std::set<std::string_view> names;
  for (const StopReason reason : all_stop_reasons()) {
    EXPECT_EQ(stop_reason_from_string(to_string(reason)), reason);
    EXPECT_FALSE(describe(reason).empty());
    names.insert(to_string(reason));
  }
  EXPECT_EQ(names.size(), 10u);
  EXPECT_EQ(stop_reason_from_string("bored"), std::nullopt);
}

}  // namespace
}  // namespace nextview

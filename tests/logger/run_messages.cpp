#include "tests/logger/run_messages.h"

#include "sensor/range_image_message.h"
#include "tests/lcmtypes/examples.h"

namespace nextview {
namespace {

template <class Message>
Message keyed(int view, int attempt) {
  auto message = example<Message>();
  message.run = config_message().run;
  message.view = view;
  message.attempt = attempt;
  return message;
}

std::vector<range_image_t> any_image(int view = 1, int attempt = 1) {
  RangeImage image;
  image.rays = make_ray_table(TiltedLineScan::with_aperture(200, 100, 1.0));
  image.range_m.assign(image.rays.pixels(), 2.0F);
  image.position_m = {1.0, 1.0, 1.0};
  image.pose.position_m = image.position_m;
  return range_image_messages(image, view, attempt, 0);
}

}  // namespace

run_config_t config_message() {
  static const run_config_t message = [] {
    auto config = example<run_config_t>();
    config.planner.max_views = 9;
    config.planner.max_attempts = 3;
    const range_image_t part = any_image().front();
    config.sensor.geometry = part.geometry;
    config.sensor.columns = part.columns;
    config.sensor.rows = part.rows;
    return config;
  }();
  return message;
}

goal_t goal_of(int view, int attempt) { return keyed<goal_t>(view, attempt); }
search_t search_of(int view, int attempt) { return keyed<search_t>(view, attempt); }

arrival_t arrival_of(int view, int attempt, bool arrived) {
  auto arrival = keyed<arrival_t>(view, attempt);
  arrival.arrived = arrived ? 1 : 0;
  arrival.refusal = arrived ? "" : "a wall is in the way";
  return arrival;
}

std::vector<range_image_t> image_of(int view, int attempt) {
  auto parts = any_image(view, attempt);
  for (range_image_t& part : parts) part.run = config_message().run;
  return parts;
}

commit_t commit_of(int view, int attempt) { return keyed<commit_t>(view, attempt); }

stop_t stop_after(int views, int final_attempt, const std::string& reason) {
  auto stop = example<stop_t>();
  stop.run = config_message().run;
  stop.views = views;
  stop.final_attempt = final_attempt;
  stop.stop_reason = reason;
  return stop;
}

void add_view(RunRecord& record, int view, int attempt) {
  for (int tried = 1; tried <= attempt; ++tried) {
    record.add(goal_of(view, tried));
    if (view > 1) record.add(search_of(view, tried));
    record.add(arrival_of(view, tried, tried == attempt));
  }
  for (const range_image_t& part : image_of(view, attempt)) record.add(part);
  record.add(commit_of(view, attempt));
}

}  // namespace nextview

#include "reports/view_rows.h"

#include <utility>

#include "mapper/mapper_config.h"

namespace nextview {

namespace {

/// As far as they have come.
void take_timings(const RunRecord& record, ViewRow& row) {
  const int attempt = row.commit.attempt;
  row.plan_s = record.duration_s(row.view, attempt, "plan");
  row.first_plan_s = record.duration_s(row.view, 1, "plan");
  row.move_s = record.duration_s(row.view, attempt, "move");
  row.scan_s = record.duration_s(row.view, attempt, "scan");
  row.update_s = record.duration_s(row.view, attempt, "update");
  row.digest_s = record.duration_s(row.view, attempt, "digest");
  // These two come with the first goal of the next view, or with the end of the run.
  for (const int next_attempt : {1, 0}) {
    if (!row.fold_s) row.fold_s = record.duration_s(row.view + 1, next_attempt, "fold_before");
    if (!row.wait_s) row.wait_s = record.duration_s(row.view + 1, next_attempt, "wait_before");
  }
  row.refused_s = 0.0;
  for (int refused = 1; refused < attempt; ++refused) {
    const auto move_s = record.duration_s(row.view, refused, "move");
    const auto plan_s = record.duration_s(row.view, refused + 1, "plan");
    if (!move_s || !plan_s) {
      row.refused_s.reset();
      return;
    }
    *row.refused_s += *move_s + *plan_s;
  }
}

}  // namespace

ViewRows::ViewRows(const run_config_t& config) : builder_(grid_of(config), window_of(config)) {}

const ViewRow* ViewRows::advance(RunRecord& record) {
  const int view = static_cast<int>(rows_.size()) + 1;
  if (!record.missing_of_view(view).empty()) return nullptr;
  ViewRow row;
  row.view = view;
  row.commit = *record.commit(view);
  const int attempt = row.commit.attempt;
  row.goal = *record.goal(view, attempt);
  row.arrival = *record.arrival(view, attempt);
  take_timings(record, row);
  const FoldReport& fold = builder_.fold(record.range_image(view, attempt)->image);
  coverage_.add_view(builder_.map(), fold);
  precision_.add_view(builder_.map(), fold);
  row.surface_coverage = coverage_.after_view(view);
  row.surface_precision = precision_.after_view(view);
  record.forget_range_image(view, attempt);
  return &rows_.emplace_back(std::move(row));
}

void ViewRows::set_visible(const VisibleSurface& surface) {
  coverage_.set_visible(builder_.map(), surface);
}

void ViewRows::set_near(NearSurface near) { precision_.set_near(builder_.map(), std::move(near)); }

void ViewRows::complete(const RunRecord& record) {
  for (ViewRow& row : rows_) {
    row.surface_coverage = coverage_.after_view(row.view);
    row.surface_precision = precision_.after_view(row.view);
    take_timings(record, row);
  }
}

}  // namespace nextview

#include "report/view_rows.h"

#include "mapper/mapper_config.h"

namespace nextview {

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
  const RecordedRangeImage& image = *record.range_image(view, attempt);
  row.scan_wall_s = image.scan_wall_s;
  row.first_plan_wall_s = record.goal(view, 1)->plan_wall_s;
  for (int refused = 1; refused < attempt; ++refused) {
    row.refused_wall_s +=
        record.arrival(view, refused)->move_wall_s + record.goal(view, refused + 1)->plan_wall_s;
  }
  const FoldReport& fold = builder_.fold(image.received.image);
  coverage_.add_view(builder_.map(), fold);
  row.surface_coverage = coverage_.after_view(view);
  record.forget_range_image(view, attempt);
  return &rows_.emplace_back(std::move(row));
}

void ViewRows::set_visible(const VisibleSurface& surface) {
  coverage_.set_visible(builder_.map(), surface);
}

void ViewRows::complete(const RunRecord& record) {
  for (ViewRow& row : rows_) {
    row.surface_coverage = coverage_.after_view(row.view);
    // The planner says how long a view took with the goal of the next one, or at the end.
    if (const search_t* search = record.search(row.view + 1, 1)) {
      row.fold_wall_s = search->fold_wall_s;
      row.wait_wall_s = search->wait_wall_s;
    } else if (record.stop() && record.stop()->views == row.view) {
      row.fold_wall_s = record.stop()->fold_wall_s;
      row.wait_wall_s = record.stop()->wait_wall_s;
    }
  }
}

}  // namespace nextview

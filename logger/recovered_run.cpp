#include "logger/recovered_run.h"

#include <algorithm>

#include "mapper/mapper_config.h"

namespace nextview {

RecoveredRun recover_run(const std::filesystem::path& folder_or_log,
                         std::optional<std::int64_t> run, int max_views) {
  const std::filesystem::path file = log_file_of(folder_or_log);
  RunLog log(file, run, RangeImages::Keep);
  log.read_on();
  const RunRecord& record = log.record();
  if (!record.config()) {
    throw LogError(file.string() + ": no run's configuration is in the log" +
                   (run ? " with the number " + std::to_string(*run) : std::string()));
  }
  const run_config_t& config = *record.config();
  MapBuilder builder(grid_of(config), window_of(config));
  std::vector<const ReceivedRangeImage*> images;
  for (int view = 1; view <= std::min(max_views, record.latest_view()); ++view) {
    const commit_t* commit = record.commit(view);
    if (commit == nullptr || !record.missing_of_view(view).empty()) break;
    images.push_back(record.range_image(view, commit->attempt));
    builder.fold(images.back()->image);
  }
  if (images.empty()) {
    throw LogError(file.string() +
                   ": no whole view is in the log; nextview_replay says what is missing");
  }
  const commit_t& last = *record.commit(static_cast<int>(images.size()));
  if (builder.digest() != last.map_digest) {
    throw LogError(file.string() + ": after view " + std::to_string(last.view) +
                   " the map is not the run's, " + last.map_digest +
                   "; nextview_replay says from where on it differs");
  }
  // The images lie in the record's map, whose entries stay where they are when it is moved.
  return {std::move(log), std::move(images), std::move(builder)};
}

std::filesystem::path log_file_of(const std::filesystem::path& folder_or_log) {
  if (!std::filesystem::exists(folder_or_log)) {
    throw LogError(folder_or_log.string() + ": no such folder");
  }
  if (!std::filesystem::is_directory(folder_or_log)) return folder_or_log;
  return folder_or_log / "run.lcmlog";
}

}  // namespace nextview

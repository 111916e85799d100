#include "logger/recovered_run.h"

#include <algorithm>
#include <map>
#include <string>

#include "mapper/mapper_config.h"

namespace nextview {
namespace {

/// The number behind a part's name; nothing for another file.
std::optional<int> part_number(const std::filesystem::path& file, const std::string& name) {
  const std::string of_part = file.filename().string();
  if (of_part.size() <= name.size() + 1 || !of_part.starts_with(name + ".")) return std::nullopt;
  const std::string digits = of_part.substr(name.size() + 1);
  constexpr std::size_t kMostDigits = 6;
  if (digits.size() > kMostDigits || digits.find_first_not_of("0123456789") != std::string::npos) {
    return std::nullopt;
  }
  return std::stoi(digits);
}

std::vector<std::filesystem::path> parts_of(const std::filesystem::path& log) {
  std::map<int, std::filesystem::path> parts;
  bool rotated = true;
  std::error_code none;
  const auto folder = log.has_parent_path() ? log.parent_path() : std::filesystem::path(".");
  for (const auto& entry : std::filesystem::directory_iterator(folder, none)) {
    const auto number = part_number(entry.path(), log.filename().string());
    if (!number) continue;
    parts.emplace(*number, entry.path());
    // Counting up, lcm-logger writes two digits at least.
    rotated &= *number > 9 || entry.path().extension().string().size() == 2;
  }
  std::vector<std::filesystem::path> files;
  files.reserve(parts.size());
  for (const auto& [number, file] : parts) files.push_back(file);
  if (rotated) std::reverse(files.begin(), files.end());
  return files;
}

}  // namespace

RecoveredRun recover_run(const std::filesystem::path& folder_or_log,
                         std::optional<std::int64_t> run, int max_views) {
  const std::vector<std::filesystem::path> files = log_files_of(folder_or_log);
  const std::filesystem::path& file = files.front();
  RunLog log(files, run, RangeImages::Keep);
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
  if (!std::filesystem::exists(folder_or_log) && parts_of(folder_or_log).empty()) {
    throw LogError(folder_or_log.string() + ": no such folder");
  }
  if (!std::filesystem::is_directory(folder_or_log)) return folder_or_log;
  return folder_or_log / "run.lcmlog";
}

std::vector<std::filesystem::path> log_files_of(const std::filesystem::path& folder_or_log) {
  const std::filesystem::path file = log_file_of(folder_or_log);
  std::vector<std::filesystem::path> parts;
  if (!std::filesystem::exists(file)) parts = parts_of(file);
  return parts.empty() ? std::vector{file} : parts;
}

}  // namespace nextview

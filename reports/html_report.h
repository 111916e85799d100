#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <ostream>
#include <string>
#include <vector>

namespace nextview {

/// All that a page shows of a run, as the page's script reads it: settings, end, figures of each
/// view, the recovered surface and path, pictures, counters. From the log; from summary.json and
/// views.csv beside it what the log does not know, where they are.
/// @param folder_or_log folder of a run, or its log
/// @throws LogError when there is no log of a run
nlohmann::ordered_json report_data(const std::filesystem::path& folder_or_log);

/// One page in one file about one run, or about several beside each other. It asks for nothing from
/// anywhere: its script, style, pictures and data are in it.
void write_html_report(std::ostream& out, const std::vector<nlohmann::ordered_json>& runs);

}  // namespace nextview

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>

#include "exporter/export_formats.h"
#include "lcmtypes/nearest_option.h"
#include "lcmtypes/program_version.h"
#include "lcmtypes/standard_output.h"

namespace {

std::vector<std::string> format_names() {
  std::vector<std::string> names;
  for (const nextview::ExportFormat& format : nextview::export_formats()) {
    names.push_back(format.name);
  }
  return names;
}

std::string format_list() {
  std::string list = "Formats:\n";
  for (const nextview::ExportFormat& format : nextview::export_formats()) {
    list += "  " + format.name +
            std::string(14 - std::min<std::size_t>(format.name.size(), 13), ' ') +
            format.description + "\n";
  }
  return list +
         "Everything is in metres in the world frame (right-handed, z up); where a format says\n"
         "otherwise, exporter/README.md does too.";
}

/// Where a file goes unless it is said: a folder of its own beside the log.
std::filesystem::path default_file(const nextview::ExportOptions& options,
                                   const std::string& name) {
  return nextview::log_file_of(options.folder_or_log).parent_path() / "export" / name;
}

void export_run(const nextview::ExportOptions& options, const std::vector<std::string>& wanted,
                const std::filesystem::path& given_file) {
  nextview::RecoveredRun run =
      nextview::recover_run(options.folder_or_log, options.run, options.max_views);
  for (const nextview::ExportFormat& format : nextview::export_formats()) {
    if (std::find(wanted.begin(), wanted.end(), format.name) == wanted.end()) continue;
    const std::filesystem::path file =
        given_file.empty() ? default_file(options, format.name) : given_file;
    if (given_file.empty()) std::filesystem::create_directories(file.parent_path());
    format.write(run, options, file);
    std::cout << file.string() << ": " << format.description << ", " << run.images.size()
              << " views, " << std::filesystem::file_size(file) << " bytes" << std::endl;
  }
}

}  // namespace

int main(int argc, char** argv) {
  nextview::answer_for_standard_output();
  CLI::App app{
      "Turns a run into files other programs open, from its log alone: the map is built again as\n"
      "./replay does.\n"};
  nextview::ExportOptions options;
  std::vector<std::string> wanted;
  std::filesystem::path file;
  app.add_option("DIR", options.folder_or_log, "Folder of a run, or its log")->required();
  app.add_option("--to", wanted, "What to write, one or several of the formats below")
      ->required()
      ->check(CLI::IsMember(format_names()));
  app.add_option("--out", file, "The file to write; default export/FORMAT beside the log");
  app.add_option("--views", options.max_views, "The first views only; default all")
      ->check(CLI::PositiveNumber);
  app.add_option("--triangles", options.simplify.triangles,
                 "Meshes: simplify down to about so many triangles")
      ->check(CLI::PositiveNumber);
  app.add_option("--error", options.simplify.error_m,
                 "Meshes: simplify as far as the surface moves by no more than about this, metres")
      ->check(CLI::NonNegativeNumber);
  app.add_flag("--fill-holes", options.fill_holes,
               "Voxels and octomap.bt: fill holes of one voxel, as meshes always have them; among "
               "voxels they are told by a field of their own");
  app.add_option("--run", options.run, "Which run, when the log holds several");
  app.failure_message(nextview::what_is_wrong);
  app.set_version_flag("--version", "nextview_export " + std::string(nextview::program_version()));
  app.footer(format_list());
  CLI11_PARSE(app, argc, argv);
  try {
    if (!file.empty() && wanted.size() > 1) {
      throw std::invalid_argument("--out names one file; give one --to with it");
    }
    export_run(options, wanted, file);
  } catch (const std::exception& error) {
    std::cerr << "nextview_export: " << error.what() << std::endl;
    return 1;
  }
  return 0;
}

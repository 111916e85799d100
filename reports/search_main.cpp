#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>

#include "lcmtypes/nearest_option.h"
#include "lcmtypes/program_version.h"
#include "lcmtypes/standard_output.h"
#include "logger/run_log.h"
#include "reports/search_report.h"

namespace {

/// A search among the first views, while there is much to find, shows most.
constexpr int kEarlyViews = 15;

}  // namespace

int main(int argc, char** argv) {
  nextview::answer_for_standard_output();
  CLI::App app{
      "Says as JSON what the search for a view has tried (paper figure 6): positions, the best\n"
      "direction and fitness at each, and the points sensed where it began. From the log alone.\n"};
  std::string folder;
  int view = 0;
  app.add_option("DIR", folder, "Folder of a run")->required()->check(CLI::ExistingDirectory);
  app.add_option("--view", view,
                 "Which view's; default: among the first 15 the one for which most positions were "
                 "tried")
      ->check(CLI::Range(2, 1000000));
  app.failure_message(nextview::what_is_wrong);
  app.set_version_flag("--version", "nextview_search " + std::string(nextview::program_version()));
  CLI11_PARSE(app, argc, argv);
  const std::filesystem::path file = std::filesystem::path(folder) / "run.lcmlog";
  try {
    nextview::RunLog log(file, std::nullopt, nextview::RangeImages::Keep);
    log.read_on();
    if (view == 0) view = nextview::largest_search(log.record(), kEarlyViews);
    if (view == 0) throw std::invalid_argument("the log has no search");
    nextview::write_search(std::cout, log.record(), view);
  } catch (const nextview::LogError& error) {
    std::cerr << "nextview_search: " << error.what() << std::endl;
    return 1;
  } catch (const std::exception& error) {
    std::cerr << "nextview_search: " << file.string() << ": " << error.what() << std::endl;
    return 1;
  }
  return 0;
}

#include <CLI/CLI.hpp>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <stdexcept>

#include "lcmtypes/nearest_option.h"
#include "lcmtypes/program_version.h"
#include "lcmtypes/standard_output.h"
#include "logger/recovered_run.h"
#include "reports/html_report.h"

namespace {

void write_report(const std::vector<std::string>& folders, const std::filesystem::path& file) {
  std::vector<nlohmann::ordered_json> runs;
  runs.reserve(folders.size());
  for (const std::string& folder : folders) runs.push_back(nextview::report_data(folder));
  std::ofstream out(file, std::ios::binary);
  if (!out) throw std::runtime_error(file.string() + ": cannot be written; does its folder exist?");
  nextview::write_html_report(out, runs);
  out.flush();
  if (!out) throw std::runtime_error(file.string() + ": could not be written in whole; disk full?");
  std::cout << file.string() << ": " << runs.size() << (runs.size() == 1 ? " run, " : " runs, ")
            << std::filesystem::file_size(file) << " bytes" << std::endl;
}

}  // namespace

int main(int argc, char** argv) {
  nextview::answer_for_standard_output();
  CLI::App app{
      "Writes a page about a run, or about several beside each other, in one HTML file that asks "
      "for\n"
      "nothing from anywhere: settings, figures, curves, pictures, the recovered surface and the "
      "path\n"
      "to turn around, what stopped the run, and how reliable its messages were.\n"};
  std::vector<std::string> folders;
  std::string file;
  app.add_option("DIR", folders, "Folders of runs, or their logs")->required();
  app.add_option(
      "--out", file,
      "HTML file to write; default report.html in the folder of the only run, of several "
      "comparison.html where you are");
  app.failure_message(nextview::what_is_wrong);
  app.set_version_flag("--version", "nextview_report " + std::string(nextview::program_version()));
  CLI11_PARSE(app, argc, argv);
  try {
    if (file.empty()) {
      file = folders.size() > 1
                 ? "comparison.html"
                 : (nextview::log_file_of(folders[0]).parent_path() / "report.html").string();
    }
    write_report(folders, file);
  } catch (const std::exception& error) {
    std::cerr << "nextview_report: " << error.what() << std::endl;
    return 1;
  }
  return 0;
}

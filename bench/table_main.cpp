// Reads the JSON of nextview_bench and prints it for people: conditions, what differs, figures with
// ratios, and where they stand against what was asked for.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <fstream>
#include <iostream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "lcmtypes/program_version.h"
#include "lcmtypes/standard_output.h"
#include "reports/median.h"

namespace {

using nextview::median;

using Json = nlohmann::ordered_json;

// All repetitions of one benchmark.
struct Figure {
  std::vector<double> items_per_second;
  std::vector<double> time_ms;
  std::map<std::string, std::vector<double>> counters;
};
using Figures = std::map<std::string, Figure>;  // by name, options of the library cut off

// Half of the repetitions' whole range, as a share of the median.
double spread(const std::vector<double>& values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return 0.5 * (*high - *low) / median(values);
}

double milliseconds(double value, const std::string& unit) {
  return unit == "s"    ? 1e3 * value
         : unit == "us" ? 1e-3 * value
         : unit == "ns" ? 1e-6 * value
                        : value;
}

std::string without_options(std::string name) {
  for (const char* option : {"/real_time", "/manual_time", "/iterations:", "/repeats:"}) {
    const std::size_t at = name.find(option);
    if (at != std::string::npos) name.erase(at);
  }
  return name;
}

// Google Benchmark writes NaN where a counter's mean is 0, which is no JSON.
Json read_json(const std::string& path) {
  std::ifstream file(path);
  std::string text(std::istreambuf_iterator<char>(file), {});
  const std::string nan = ": NaN";
  for (std::size_t at = text.find(nan); at != std::string::npos; at = text.find(nan, at)) {
    text.replace(at, nan.size(), ": null");
  }
  return Json::parse(text);
}

Figures read_figures(const Json& json, std::vector<std::string>& order,
                     std::vector<std::string>& failed) {
  // What Google Benchmark itself writes for every repetition; the rest are counters.
  const std::vector<std::string> kOwn = {"family_index",    "per_family_instance_index",
                                         "repetitions",     "repetition_index",
                                         "threads",         "iterations",
                                         "real_time",       "cpu_time",
                                         "items_per_second"};
  Figures figures;
  for (const Json& run : json.at("benchmarks")) {
    if (run.at("run_type") != "iteration") continue;
    const std::string name = without_options(run.at("run_name"));
    if (run.value("error_occurred", false)) {
      failed.push_back(name + ": " + run.value("error_message", ""));
      continue;
    }
    if (!figures.contains(name)) order.push_back(name);
    Figure& figure = figures[name];
    figure.items_per_second.push_back(run.value("items_per_second", 0.0));
    // Google Benchmark divides by the processor's time unless a benchmark asks for another.
    const std::string full_name = run.at("run_name");
    const bool by_clock =
        full_name.ends_with("_time") || full_name.find("_time/") != std::string::npos;
    figure.time_ms.push_back(
        milliseconds(run.at(by_clock ? "real_time" : "cpu_time"), run.at("time_unit")));
    for (const auto& [key, value] : run.items()) {
      if (value.is_number() && std::find(kOwn.begin(), kOwn.end(), key) == kOwn.end()) {
        figure.counters[key].push_back(value);
      }
    }
  }
  return figures;
}

void print_context(const Json& context) {
  fmt::print("Date {}, load {}\n", context.value("date", "?"),
             context.contains("load_avg") ? context.at("load_avg").dump() : "?");
  for (const std::string kind : {"condition ", "skipped ", "differ ", "fitness error "}) {
    if (kind == "differ ") fmt::print("\nAnswers that differ\n");
    for (const auto& [key, value] : context.items()) {
      if (key.starts_with(kind)) {
        fmt::print("  {}: {}\n",
                   key.substr(kind == "condition " || kind == "differ " ? kind.size() : 0),
                   value.get<std::string>());
      }
    }
  }
}

// A benchmark's name is group/what/setting; figures of the same group and setting are compared.
struct Place {
  std::string table;
  std::string what;
};

Place place_of(const std::string& name) {
  const std::size_t first = name.find('/');
  const std::size_t second = name.find('/', first + 1);
  return {name.substr(0, first) + ", " + name.substr(second + 1),
          name.substr(first + 1, second - first - 1)};
}

std::string rate_text(double items_per_second) {
  return items_per_second >= 1e5 ? fmt::format("{:.2f} M/s", items_per_second * 1e-6)
                                 : fmt::format("{:.1f} /s", items_per_second);
}

void print_tables(const Figures& figures, const std::vector<std::string>& order) {
  std::map<std::string, std::vector<std::string>> tables;
  std::vector<std::string> table_order;
  for (const std::string& name : order) {
    const std::string table = place_of(name).table;
    if (!tables.contains(table)) table_order.push_back(table);
    tables[table].push_back(name);
  }
  for (const std::string& table : table_order) {
    double ours_ms = 0.0;
    for (const std::string& name : tables[table]) {
      if (place_of(name).what == "nextview") ours_ms = median(figures.at(name).time_ms);
    }
    std::sort(tables[table].begin(), tables[table].end(),
              [&](const std::string& a, const std::string& b) {
                return median(figures.at(a).time_ms) < median(figures.at(b).time_ms);
              });
    fmt::print("\n{}\n  {:<34} {:>12} {:>14} {:>7}  {}\n", table, "", "median", "a second", "+-",
               "of nextview's time");
    for (const std::string& name : tables[table]) {
      const Figure& figure = figures.at(name);
      const double rate = median(figure.items_per_second);
      fmt::print("  {:<34} {:9.3f} ms {:>14} {:5.1f} %", place_of(name).what,
                 median(figure.time_ms), rate_text(rate), 100.0 * spread(figure.items_per_second));
      if (ours_ms > 0.0) fmt::print("  {:8.2f} x", median(figure.time_ms) / ours_ms);
      for (const auto& [counter, values] : figure.counters) {
        fmt::print("  {} {:.4g}", counter, median(values));
      }
      fmt::print("\n");
    }
  }
}

class Goals {
 public:
  explicit Goals(const Figures& figures) : figures_(figures) {}

  void at_least(double wanted, const std::string& ours, const std::string& theirs) const {
    if (!figures_.contains(ours) || !figures_.contains(theirs)) return;
    const double ratio =
        median(figures_.at(ours).items_per_second) / median(figures_.at(theirs).items_per_second);
    print(ratio >= wanted, ratio, "x", "at least", wanted, ours + " : " + theirs);
  }
  void time_at_most(double wanted, const std::string& ours, const std::string& theirs) const {
    if (!figures_.contains(ours) || !figures_.contains(theirs)) return;
    const double ratio = median(figures_.at(ours).time_ms) / median(figures_.at(theirs).time_ms);
    print(ratio <= wanted, ratio, "x", "at most", wanted, "time of " + ours + " : " + theirs);
  }
  void ms_at_most(double wanted, const std::string& ours, const std::string& counter = "") const {
    if (!figures_.contains(ours)) return;
    const Figure& figure = figures_.at(ours);
    const double ms = median(counter.empty() ? figure.time_ms : figure.counters.at(counter));
    print(ms <= wanted, ms, "ms", "at most", wanted, ours + (counter.empty() ? "" : " " + counter));
  }

 private:
  static void print(bool met, double value, const char* unit, const char* relation, double wanted,
                    const std::string& what) {
    fmt::print("  {:<7} {:9.2f} {:<2}  ({} {:g})  {}\n", met ? "met" : "MISSED", value, unit,
               relation, wanted, what);
  }
  const Figures& figures_;
};

void print_goals(const Figures& figures) {
  fmt::print("\nAgainst what was asked for\n");
  const Goals goals(figures);
  for (const std::string target : {"", "_on_AVX2"}) {
    const std::string ours = "view_evaluation/nextview" + target + "/5cm";
    goals.at_least(40.0, ours, "view_evaluation/textbook/5cm");
    goals.at_least(200.0, ours, "view_evaluation/octomap/5cm");
  }
  for (const std::string size : {"/10cm", "/5cm", "/2cm"}) {
    for (const std::string directions : {"320", "1280"}) {
      goals.time_at_most(2.0, "view_evaluation/nextview_panorama_" + directions + size,
                         "view_evaluation/nextview" + size);
    }
  }
  for (const std::string room : {"boxes", "columns"}) {
    const std::string run = "/" + room + "/10cm/all_views";
    goals.ms_at_most(10.0, "decision/nextview" + run, "median_ms");
    goals.at_least(50.0, "decision/nextview" + run, "decision/textbook" + run);
    goals.at_least(1.7, "decision/nextview_2_threads" + run, "decision/nextview" + run);
  }
  goals.at_least(10.0, "map_update/nextview/5cm", "map_update/octomap/5cm");
  goals.at_least(50.0, "map_update/nextview/5cm", "map_update/openvdb/5cm");
  goals.at_least(25.0, "map_update/nextview_marking/5cm", "map_update/octomap/5cm");
  for (const std::string digest : {"", "with_digest_"}) {
    for (const std::string size : {"10cm", "5cm"}) {
      goals.time_at_most(1.2, "map_update/nextview_" + digest + "after_100_rooms/" + size,
                         "map_update/nextview_" + digest + "after_1_room/" + size);
    }
  }
  for (const std::string scene : {"boxes", "conference"}) {
    goals.at_least(0.8, "scan/nextview/" + scene + "/500x500", "scan/embree/" + scene + "/500x500");
  }
  goals.ms_at_most(15.0, "scan/nextview/conference/500x500");
}

// Puts what another process has measured behind what is there.
void append(Json& all, const Json& part) {
  if (all.is_null()) {
    all = part;
    return;
  }
  for (const auto& [key, value] : part.at("context").items()) {
    if (!all["context"].contains(key)) all["context"][key] = value;
  }
  for (const Json& run : part.at("benchmarks")) all["benchmarks"].push_back(run);
}

void print(const Json& json) {
  std::vector<std::string> order;
  std::vector<std::string> failed;
  const Figures figures = read_figures(json, order, failed);
  print_context(json.at("context"));
  print_tables(figures, order);
  print_goals(figures);
  for (const std::string& line : failed) fmt::print("\nNOT MEASURED: {}\n", line);
}

}  // namespace

int main(int argc, char** argv) {
  nextview::answer_for_standard_output();
  CLI::App app("Prints what nextview_bench has measured.");
  std::vector<std::string> files;
  std::string merged;
  app.add_option("FILE", files, "JSON of nextview_bench; several are put together")
      ->required()
      ->check(CLI::ExistingFile);
  app.add_option("--merge", merged, "Write them as one to this file");
  app.set_version_flag("--version",
                       "nextview_bench_table " + std::string(nextview::program_version()));
  CLI11_PARSE(app, argc, argv);
  Json json;
  for (const std::string& file : files) {
    try {
      append(json, read_json(file));
    } catch (const Json::exception& error) {
      std::cerr << file << " is not what nextview_bench writes: " << error.what() << "\n";
      return 1;
    }
  }
  if (!merged.empty() && !(std::ofstream(merged) << json.dump(2) << '\n')) {
    std::cerr << merged << " cannot be written\n";
    return 1;
  }
  try {
    print(json);
  } catch (const Json::exception& error) {
    std::cerr << "not what nextview_bench writes: " << error.what() << "\n";
    return 1;
  }
  return 0;
}

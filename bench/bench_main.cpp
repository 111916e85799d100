#include <benchmark/benchmark.h>

#include <iostream>
#include <map>
#include <string>
#include <string_view>

#include "bench/bench_groups.h"
#include "lcmtypes/standard_output.h"
#include "lcmtypes/tell_version.h"

// nextview_bench [--quick] [--group=NAME] and all options of Google Benchmark.
int main(int argc, char** argv) {
  using namespace nextview;
  answer_for_standard_output();
  if (tell_version(argc, argv)) return 0;
  const std::map<std::string, void (*)(const BenchOptions&)> groups = {
      {"view_evaluation", register_view_evaluation},
      {"map_update", register_map_update},
      {"decision", register_decision},
      {"scan", register_scan},
      {"bus", register_bus}};

  benchmark::Initialize(&argc, argv);
  BenchOptions options;
  std::string only;
  for (int i = 1; i < argc; ++i) {
    const std::string_view argument = argv[i];
    if (argument == "--quick") {
      options.quick = true;
    } else if (argument.starts_with("--group=")) {
      only = argument.substr(argument.find('=') + 1);
    } else {
      std::cerr << "nextview_bench: unknown option " << argument << "\n";
      return 2;
    }
  }
  if (!only.empty() && !groups.contains(only)) {
    std::cerr << "nextview_bench: no group " << only << "; there are:";
    for (const auto& [name, register_group] : groups) std::cerr << " " << name;
    std::cerr << "\n";
    return 2;
  }
  report_conditions();
  for (const auto& [name, register_group] : groups) {
    if (only.empty() || only == name) register_group(options);
  }
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}

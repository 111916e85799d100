#include "bench/conditions.h"

#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <tbb/version.h>

#include <cstdlib>
#include <fstream>
#include <iostream>

#include "bench/openvdb_map.h"
#include "planner/prediction/ray_kernel.h"

namespace nextview {

namespace {

std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  }
  return "unknown";
}

}  // namespace

void report_condition(const std::string& name, const std::string& value) {
  benchmark::AddCustomContext(name, value);
  std::cerr << name << ": " << value << std::endl;
}

void report_conditions() {
  report_condition("condition processor", processor());
  report_condition("condition ray kernel", ray_kernel_target());
#ifdef __clang__
  report_condition("condition compiler", "clang " __clang_version__);
#else
  report_condition("condition compiler", "g++ " __VERSION__);
#endif
  report_condition("condition flags", NEXTVIEW_BENCH_FLAGS);
  report_condition("condition libraries",
                   std::string("OctoMap " NEXTVIEW_OCTOMAP_VERSION ", OpenVDB ") +
                       openvdb_version() + ", Embree " NEXTVIEW_EMBREE_VERSION ", TBB " +
                       TBB_runtime_version());
}

void Agreement::report(const std::string& of_what, const std::string& remark) const {
  const double percent =
      compared_ == 0 ? 0.0 : 100.0 * static_cast<double>(differ_) / static_cast<double>(compared_);
  report_condition("differ " + pair_, fmt::format("{:.4f} % of {} {}{}{}", percent, compared_,
                                                  of_what, remark.empty() ? "" : "; ", remark));
}

void Agreement::report_and_require_none(const std::string& of_what) const {
  report(of_what);
  if (differ_ != 0 || compared_ == 0) {
    std::cerr << "These must be the same. Nothing was measured." << std::endl;
    std::exit(1);
  }
}

}  // namespace nextview

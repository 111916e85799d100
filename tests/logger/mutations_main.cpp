#include <CLI/CLI.hpp>
#include <array>
#include <fstream>
#include <iostream>
#include <iterator>

#include "lcmtypes/nearest_option.h"
#include "lcmtypes/program_version.h"
#include "lcmtypes/standard_output.h"
#include "tests/logger/log_mutations.h"

namespace {

using namespace nextview;

struct Row {
  MutationKind kind;
  int mutations;
};

/// A thousand.
constexpr std::array kRows = {
    Row{MutationKind::BitFlip, 300},     Row{MutationKind::FieldChange, 386},
    Row{MutationKind::Truncation, 114},  Row{MutationKind::MissingEvent, 50},
    Row{MutationKind::DoubledEvent, 50}, Row{MutationKind::SwappedEvents, 50},
    Row{MutationKind::ForeignEvent, 50}};

LogBytes bytes_of_file(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

int mutate(const LogBytes& log, std::uint64_t seed, bool planner) {
  if (notice_of({.what = "nothing", .log = log}, log, planner) == Notice::Status) {
    std::cerr << "nextview_mutations: the log does not agree as it is: see nextview_replay\n";
    return 1;
  }
  std::cout << "| changed | times | status not 0 | status 0, and named | unnoticed |\n"
               "|---|---|---|---|---|\n";
  int all_unnoticed = 0;
  for (const Row& row : kRows) {
    std::array<int, 3> notices{};
    for (int i = 0; i < row.mutations; ++i) {
      const Mutation mutation =
          mutated(log, row.kind, seed * 1'000'000 + static_cast<std::uint64_t>(i));
      const Notice notice = notice_of(mutation, log, planner);
      ++notices.at(static_cast<std::size_t>(notice));
      if (notice == Notice::Nothing) {
        std::cerr << "unnoticed: " << to_string(row.kind) << ", " << mutation.what << "\n";
      }
    }
    std::cout << "| " << to_string(row.kind) << " | " << row.mutations << " | " << notices[0]
              << " | " << notices[1] << " | " << notices[2] << " |" << std::endl;
    all_unnoticed += notices[2];
  }
  return all_unnoticed == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  nextview::answer_for_standard_output();
  CLI::App app{
      "Changes one thing in the log of a run, a thousand times by chance, and counts what a "
      "replay\n"
      "makes of it. Exit status 1 when one passes unnoticed.\n"};
  app.failure_message(nextview::what_is_wrong);
  app.set_version_flag("--version",
                       "nextview_mutations " + std::string(nextview::program_version()));
  std::string file;
  std::uint64_t seed = 1;
  bool planner = false;
  bool without_seal = false;
  app.add_option("LOG", file, "An LCM log that replays with status 0")->required();
  app.add_option("--seed", seed, "Of what is changed");
  app.add_flag("--planner", planner, "Decide every goal again, too");
  app.add_flag("--without-seal", without_seal, "Take the seal out of the log first");
  CLI11_PARSE(app, argc, argv);
  LogBytes log = bytes_of_file(file);
  if (without_seal) log = without_last_event(log);
  if (log.empty()) {
    std::cerr << "nextview_mutations: " << file << ": cannot be read, or is empty\n";
    return 1;
  }
  return mutate(log, seed, planner);
}

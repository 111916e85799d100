// `nextview COMMAND ...` starts the program nextview_COMMAND that lies beside this one; `nextview
// doctor` looks at the machine.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <iostream>

#include "lcmtypes/program_version.h"
#include "lcmtypes/standard_output.h"
#include "runner/doctor.h"

namespace {

struct Command {
  const char* name;
  const char* what;
};
constexpr Command kCommands[] = {
    {"run", "Recover a scene: simulators, mapper, planner, recorder"},
    {"replay", "Rebuild a run's map from its log and compare every digest"},
    {"picture", "Draw what a run has recovered"},
    {"report", "A page about a run, or about several beside each other, in one HTML file"},
    {"export", "Write a run's voxels, points and poses for other programs"},
    {"viewer", "Show runs in a browser, also one that goes on"},
    {"search", "What the search for a view has tried"},
    {"bound", "How few views and metres a scene takes at least"},
    {"sensor_sim", "The simulated sensor's process alone"},
    {"base_sim", "The simulated robot's process alone"},
    {"mapper", "The mapper's process alone"},
    {"planner", "The planner's process alone"},
};
const std::string kDoctor = "doctor";

bool is_known(const std::string& name) {
  return name == kDoctor || std::any_of(std::begin(kCommands), std::end(kCommands),
                                        [&](const Command& each) { return each.name == name; });
}

int refuse(const std::string& name) {
  std::cerr << "nextview: no command '" << name << "'; there are";
  for (const Command& command : kCommands) std::cerr << " " << command.name << ",";
  std::cerr << " " << kDoctor << std::endl;
  return 1;
}

/// Returns only when it cannot.
int start(const std::string& name, char** arguments) {
  const auto folder = std::filesystem::read_symlink("/proc/self/exe").parent_path();
  std::string program = (folder / ("nextview_" + name)).string();
  arguments[0] = program.data();
  ::execv(program.c_str(), arguments);
  std::cerr << "nextview: " << program << " cannot be started: " << std::strerror(errno)
            << ": install nextview again" << std::endl;
  return 1;
}

int doctor(const std::string& cache) {
  const bool all = nextview::show_findings(std::cout, nextview::examine_machine(cache));
  std::cout << (all ? "A run will find what it needs.\n" : "Mend what fails, then ask again.\n");
  return all ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  nextview::answer_for_standard_output();
  if (argc > 1 && argv[1][0] != '-' && !is_known(argv[1])) return refuse(argv[1]);
  CLI::App app{"Lets a robot with a range sensor recover an unknown indoor scene by itself.\n"};
  app.name("nextview");
  app.set_version_flag("--version", "nextview " + std::string(nextview::program_version()));
  app.footer("nextview COMMAND --help says what each takes.");
  app.require_subcommand(1);
  app.get_formatter()->column_width(20);
  for (const Command& command : kCommands) {
    // Its options are its own program's, --help among them.
    app.add_subcommand(command.name, command.what)->prefix_command()->set_help_flag();
  }
  CLI::App& doctor_command = *app.add_subcommand(
      kDoctor, "Look whether this machine has what a run needs, and say what to type");
  std::string cache;
  doctor_command.add_option("--cache", cache, "Folder of what is kept, as nextview_run has it");
  CLI11_PARSE(app, argc, argv);
  try {
    const CLI::App& chosen = *app.get_subcommands().front();
    return &chosen == &doctor_command ? doctor(cache) : start(chosen.get_name(), argv + 1);
  } catch (const std::exception& error) {
    std::cerr << "nextview: " << error.what() << std::endl;
    return 1;
  }
}

#include "runner/doctor.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "lcmtypes/multicast_probe.h"
#include "lcmtypes/open_files.h"
#include "lcmtypes/program_version.h"
#include "lcmtypes/transport.h"
#include "runner/child_process.h"
#include "runner/port_lock.h"
#include "runner/private_network.h"
#include "scoring/kept_file.h"

namespace nextview {
namespace {

namespace fs = std::filesystem;

// What a program answers to --version; its last words when it cannot.
std::string version_of(const std::string& program) {
  ChildProcess child("program", {program, "--version"});
  while (child.running()) ::usleep(1000);
  return child.last_lines().empty() ? child.how_it_ended() : child.last_lines().back();
}

Finding programs() {
  const fs::path folder = fs::read_symlink("/proc/self/exe").parent_path();
  Finding finding{"programs", true, std::string(program_version()) + " in " + folder.string()};
  for (const char* role : {"run", "sensor_sim", "base_sim", "mapper", "planner", "replay"}) {
    const std::string name = std::string("nextview_") + role;
    std::string version;
    try {
      version = version_of((folder / name).string());
    } catch (const std::system_error& error) {
      version = error.what();
    }
    if (version != name + " " + std::string(program_version())) {
      return {"programs", false,
              name + " of another version or not to be started (" + version +
                  "): build or install nextview again"};
    }
  }
  return finding;
}

Finding recorder() {
  if (const auto path = find_in_path("lcm-logger")) return {"recorder", true, *path};
  return {"recorder", false, "no lcm-logger in PATH; type: apt-get install liblcm-bin"};
}

Finding port() {
  try {
    return {"port", true, "UDP " + std::to_string(PortLock::acquire().port()) + " is free"};
  } catch (const NoFreePort& error) {
    return {"port", false, error.what()};
  }
}

Finding network() {
  const std::string why_not = why_no_private_network();
  if (why_not.empty()) return {"network", true, "a run can have one of its own"};
  return {"network", true,
          "a run can have none of its own (" + why_not +
              "): others on this machine can speak on its bus, and its recorder hears the network"};
}

Finding multicast() {
  try {
    const PortLock lock = PortLock::acquire();
    probe_multicast(lock.lcm_url());
    return {"multicast", true, "what is sent to " + lock.lcm_url() + " comes back"};
  } catch (const std::exception& error) {
    const bool needed = !why_no_private_network().empty();
    return {
        "multicast", !needed,
        std::string(needed ? "" : "only in a network of a run's own; for others: ") + error.what()};
  }
}

Finding socket_buffers() {
  // A scan of 250 000 points in one burst; liblcm takes what the kernel grants of what a run's URL
  // asks.
  constexpr long kWanted = 2 << 20;
  const char* const kSetting = "/proc/sys/net/core/rmem_max";
  long granted = 0;
  std::ifstream(kSetting) >> granted;
  const std::string found = std::to_string(granted / 1024) + " KiB";
  if (granted >= kWanted) return {"socket buffers", true, found};
  return {"socket buffers", true,
          found +
              ", enough for the paper's sensor; for images of 250 000 points type (as root): "
              "sysctl -w net.core.rmem_max=" +
              std::to_string(kWanted)};
}

Finding open_files() {
  const std::string too_few = too_few_open_files(kOpenFilesOfRun);
  if (!too_few.empty()) return {"open files", false, too_few};
  rlimit limit{};
  ::getrlimit(RLIMIT_NOFILE, &limit);
  return {"open files", true, std::to_string(limit.rlim_cur)};
}

Finding cache(const std::string& given) {
  const std::string folder = cache_folder(given);
  std::error_code ignored;
  fs::create_directories(folder, ignored);
  if (::access(folder.c_str(), W_OK) == 0) return {"cache", true, folder};
  return {"cache", false,
          folder +
              " cannot be written to: what can be seen of a scene is worked out at every run; "
              "name a folder by --cache or NEXTVIEW_CACHE"};
}

}  // namespace

std::vector<Finding> examine_machine(const std::string& cache_option) {
  return {programs(),  recorder(),       port(),       network(),
          multicast(), socket_buffers(), open_files(), cache(cache_option)};
}

bool show_findings(std::ostream& to, const std::vector<Finding>& findings) {
  bool all = true;
  for (const Finding& finding : findings) {
    to << fmt::format("  {:<6}{:<15}{}\n", finding.good ? "ok" : "FAILS", finding.what,
                      finding.detail);
    all = all && finding.good;
  }
  return all;
}

}  // namespace nextview

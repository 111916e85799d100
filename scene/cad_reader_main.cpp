// Reads one CAD file for load_mesh, which starts it: what goes wrong in here ends this process
// only.
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <string>
#include <string_view>

#include "lcmtypes/program_version.h"
#include "lcmtypes/standard_output.h"
#include "scene/cad_answer.h"
#include "scene/cad_file.h"

namespace {

constexpr const char* kUsage =
    "nextview_cad_reader PARENT UNIT_M|- UP|- FILE\n"
    "Reads a CAD file for the other programs of nextview, which start it: a file that makes it\n"
    "crash, hang or run out of memory does them no harm. PARENT is the process that started it,\n"
    "whose end is its own. Hands back the triangles, or why there are none, on stdout.\n";

/// Ends with its parent, leaves no core, and goes first where memory runs out.
void be_expendable(pid_t parent) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) std::_Exit(1);  // it ended before the line above
  const rlimit none{0, 0};
  ::setrlimit(RLIMIT_CORE, &none);
  std::ofstream("/proc/self/oom_score_adj") << "1000";
}

/// What assimp prints must not get into the answer: from here on stdout is stderr.
std::FILE* take_stdout() {
  std::FILE* answer = ::fdopen(::dup(STDOUT_FILENO), "w");
  ::dup2(STDERR_FILENO, STDOUT_FILENO);
  return answer;
}

bool answer_into(std::FILE* file, char** argv) {
  nextview::SceneOptions options;
  try {
    if (std::string_view(argv[2]) != "-") options.unit_m = nextview::parse_unit_m(argv[2]);
    if (std::string_view(argv[3]) != "-") options.up = nextview::parse_up_axis(argv[3]);
    return write_answer(file, nextview::read_cad_file(argv[4], options));
  } catch (const std::exception& error) {
    return nextview::write_answer(file, error.what());
  }
}

/// --help, --version, or a wrong command line.
int explain(std::string_view asked) {
  if (asked == "--version") {
    std::puts(("nextview_cad_reader " + std::string(nextview::program_version())).c_str());
    return 0;
  }
  std::fputs(kUsage, asked == "--help" ? stdout : stderr);
  return asked == "--help" ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  nextview::answer_for_standard_output();
  if (argc != 5) return explain(argc == 2 ? argv[1] : "");
  be_expendable(std::atoi(argv[1]));
  std::FILE* answer = take_stdout();
  // Nothing is taken down: the system takes the memory back faster.
  std::_Exit(answer != nullptr && answer_into(answer, argv) ? 0 : 1);
}

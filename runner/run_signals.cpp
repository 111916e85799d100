#include "runner/run_signals.h"

#include <csignal>
#include <initializer_list>

namespace nextview {
namespace {

volatile std::sig_atomic_t noted = 0;

void note(int number) { noted = number; }

}  // namespace

void note_signals() {
  struct sigaction action {};
  action.sa_handler = note;  // without SA_RESTART
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction before {};
    sigaction(number, nullptr, &before);
    if (before.sa_handler == SIG_IGN) continue;  // as nohup has it
    sigaction(number, &action, nullptr);
  }
}

int noted_signal() { return noted; }

}  // namespace nextview

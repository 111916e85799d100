#include "runner/run_signals.h"

#include <csignal>

namespace nextview {
namespace {

volatile std::sig_atomic_t noted = 0;

void note(int number) { noted = number; }

}  // namespace

void note_signals() {
  struct sigaction action {};
  action.sa_handler = note;  // without SA_RESTART
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

int noted_signal() { return noted; }

}  // namespace nextview

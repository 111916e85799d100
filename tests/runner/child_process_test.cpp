#include "runner/child_process.h"

#include <gtest/gtest.h>
#include <poll.h>
#include <signal.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <unistd.h>

#include <system_error>

namespace nextview {
namespace {

ChildProcess shell(const std::string& script) { return {"shell", {"sh", "-c", script}}; }

void wait_for_end(ChildProcess& child) {
  const FileDescriptor handle(static_cast<int>(::syscall(SYS_pidfd_open, child.pid(), 0)));
  pollfd end{handle.get(), POLLIN, 0};
  ::poll(&end, 1, -1);
  child.running();
}

std::vector<std::string> wait_for_lines(ChildProcess& child) {
  for (;;) {
    child.running();
    auto lines = child.take_lines();
    if (!lines.empty()) return lines;
    ::poll(nullptr, 0, 1);
  }
}

TEST(ChildProcess, TellsItsExitStatus) {
  ChildProcess child = shell("exit 3");
  wait_for_end(child);
  EXPECT_FALSE(child.running());
  EXPECT_EQ(child.exit_status(), 3);
  EXPECT_EQ(child.how_it_ended(), "ended with status 3");
}

TEST(ChildProcess, TellsTheSignalThatEndedIt) {
  ChildProcess child = shell("kill -SEGV $$");
  wait_for_end(child);
  EXPECT_EQ(child.exit_status(), std::nullopt);
  EXPECT_EQ(child.how_it_ended(), "was killed by signal 11 (Segmentation fault)");
}

TEST(ChildProcess, KeepsItsWords) {
  ChildProcess child = shell("echo one; echo two >&2; printf 'no newline'");
  wait_for_end(child);
  EXPECT_EQ(child.take_lines(), (std::vector<std::string>{"one", "two", "no newline"}));
  EXPECT_TRUE(child.take_lines().empty());
  EXPECT_EQ(child.last_lines().back(), "no newline");
}

TEST(ChildProcess, KeepsTheLastOfManyWords) {
  ChildProcess child = shell("for i in 1 2 3 4 5 6 7 8 9; do echo line $i; done");
  wait_for_end(child);
  EXPECT_EQ(child.take_lines().size(), 9u);
  EXPECT_EQ(child.last_lines(),
            (std::deque<std::string>{"line 5", "line 6", "line 7", "line 8", "line 9"}));
}

TEST(ChildProcess, HasNothingToRead) {
  ChildProcess child = shell("read line && echo read; echo over");
  wait_for_end(child);
  EXPECT_EQ(child.take_lines(), std::vector<std::string>{"over"});
}

TEST(ChildProcess, EndsWhenAsked) {
  ChildProcess child = shell("trap 'echo bye; exit 7' TERM; echo ready; while :; do :; done");
  wait_for_lines(child);
  child.terminate(60.0);
  EXPECT_EQ(child.exit_status(), 7);
  EXPECT_EQ(child.take_lines(), std::vector<std::string>{"bye"});
}

TEST(ChildProcess, EndsWhenAskedThoughItIsStopped) {
  ChildProcess child = shell("echo ready; while :; do :; done");
  wait_for_lines(child);
  child.signal(SIGSTOP);
  child.terminate(60.0);
  EXPECT_EQ(child.how_it_ended(), "was killed by signal 15 (Terminated)");
}

TEST(ChildProcess, IsKilledWhenItDoesNotListen) {
  ChildProcess child = shell("trap '' TERM; echo ready; while :; do :; done");
  wait_for_lines(child);
  child.terminate(0.1);
  EXPECT_EQ(child.how_it_ended(), "was killed by signal 9 (Killed)");
}

TEST(ChildProcess, DoesNotOutliveItsObject) {
  pid_t pid = 0;
  {
    ChildProcess child = shell("while :; do :; done");
    pid = child.pid();
    EXPECT_TRUE(child.running());
  }
  EXPECT_EQ(::kill(pid, 0), -1);
}

TEST(ChildProcess, IsInAGroupOfItsOwn) {
  ChildProcess child = shell("echo ready; while :; do :; done");
  wait_for_lines(child);
  EXPECT_EQ(::getpgid(child.pid()), child.pid());
  EXPECT_NE(::getpgid(child.pid()), ::getpgrp());
}

TEST(ChildProcess, TellsHowMuchMemoryItHeld) {
  ChildProcess child = shell("echo ready; while :; do :; done");
  wait_for_lines(child);
  EXPECT_GT(child.peak_memory_bytes(), 100'000);
  child.terminate(60.0);
  EXPECT_GT(child.peak_memory_bytes(), 100'000);
}

TEST(ChildProcess, ThatIsNotThereIsAnError) {
  EXPECT_THROW(ChildProcess("nobody", {"/no/such/program"}), std::system_error);
}

TEST(ChildProcess, ThatIsNotThereIsAnErrorWhateverSignalsCome) {
  struct sigaction ignore {};
  ignore.sa_handler = [](int) {};  // without SA_RESTART: interrupts every wait
  struct sigaction before {};
  sigaction(SIGALRM, &ignore, &before);
  const itimerval often{{0, 200}, {0, 200}};
  setitimer(ITIMER_REAL, &often, nullptr);
  int errors = 0;
  for (int i = 0; i < 50; ++i) {
    try {
      const ChildProcess nobody("nobody", {"/no/such/program"});
    } catch (const std::system_error&) {
      ++errors;
    }
  }
  const itimerval never{};
  setitimer(ITIMER_REAL, &never, nullptr);
  sigaction(SIGALRM, &before, nullptr);
  EXPECT_EQ(errors, 50);
}

TEST(FindInPath, FindsPrograms) {
  EXPECT_TRUE(find_in_path("sh").has_value());
  EXPECT_EQ(find_in_path("no-such-program-anywhere"), std::nullopt);
}

}  // namespace
}  // namespace nextview

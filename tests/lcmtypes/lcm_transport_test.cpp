#include "lcmtypes/lcm_transport.h"

#include <gtest/gtest.h>
#include <sched.h>
#include <sys/wait.h>
#include <unistd.h>

#include <iostream>

#include "lcmtypes/bus.h"
#include "lcmtypes/multicast_probe.h"
#include "runner/port_lock.h"
#include "tests/lcmtypes/examples.h"

namespace nextview {
namespace {

using std::chrono::milliseconds;

TEST(LcmTransport, CarriesMessagesBetweenTwoBuses) {
  const PortLock port = PortLock::acquire();
  const std::string place = port.lcm_url();
  Bus planner(place, 7, "planner");
  Bus mapper(place, 7, "mapper");
  std::vector<goal_t> received;
  mapper.on<goal_t>([&](const goal_t& goal) { received.push_back(goal); });
  goal_t goal = example<goal_t>();
  constexpr int kGoals = 500;  // well over the 30 that LCM's queues hold unless told otherwise
  for (int view = 1; view <= kGoals; ++view) {
    goal.view = view;
    planner.publish(goal);
  }
  for (int asked = 0; asked < 100 && std::ssize(received) < kGoals; ++asked) {
    while (mapper.handle(milliseconds(20))) {
    }
  }
  ASSERT_EQ(std::ssize(received), kGoals);
  for (int i = 0; i < kGoals; ++i) EXPECT_EQ(received[static_cast<std::size_t>(i)].view, i + 1);
}

TEST(LcmTransport, AnswersRequests) {
  const PortLock port = PortLock::acquire();
  const std::string place = port.lcm_url();
  Bus planner(place, 7, "planner");
  Bus mapper(place, 7, "mapper");
  planner.publish(example<goal_t>());  // before the mapper listens
  int received = 0;
  mapper.on<goal_t>([&](const goal_t&) { ++received; });
  for (int asked = 0; asked < 100 && received == 0; ++asked) {
    mapper.request<goal_t>(2, 0);
    planner.handle(milliseconds(20));
    mapper.handle(milliseconds(20));
  }
  EXPECT_EQ(received, 1);
}

TEST(LcmTransport, AHandlersExceptionPassesThroughLcm) {
  const PortLock port = PortLock::acquire();
  const std::string place = port.lcm_url();
  Bus planner(place, 7, "planner");
  Bus mapper(place, 7, "mapper");
  mapper.on<goal_t>([](const goal_t&) { throw std::runtime_error("a fault of our own"); });
  planner.publish(example<goal_t>());
  EXPECT_THROW(
      {
        for (int i = 0; i < 100; ++i) mapper.handle(milliseconds(20));
      },
      std::runtime_error);
}

TEST(LcmTransport, RefusesWhatLcmWouldCutIntoFragments) {
  const PortLock port = PortLock::acquire();
  LcmTransport transport(port.lcm_url());
  EXPECT_THROW(transport.publish("NEXTVIEW_GOAL", std::vector<std::uint8_t>(kMaxMessageBytes + 1)),
               std::logic_error);
  EXPECT_NO_THROW(transport.publish("NEXTVIEW_GOAL", std::vector<std::uint8_t>(kMaxMessageBytes)));
}

std::string error_of(const std::string& lcm_url) {
  try {
    const Bus bus(lcm_url, 7, "mapper");
    return "no error";
  } catch (const BusError& error) {
    return error.what();
  }
}

TEST(LcmTransport, SaysWhatIsWrongWithAUrl) {
  EXPECT_NE(error_of("udpm://239.255.76.67:many").find("'many' is not a port"), std::string::npos);
  EXPECT_NE(error_of("udpm://239.255.76.67:70000").find("not a port"), std::string::npos);
  EXPECT_NE(error_of("udpm://127.0.0.1:7667").find("not a multicast group"), std::string::npos);
  EXPECT_NE(error_of("pigeon://here").find("pigeon://here"), std::string::npos);
  EXPECT_NE(error_of("memq://").find("leads to no other process"), std::string::npos);
}

// LCM itself tries without an end, with three lines each time.
TEST(LcmTransport, SaysThatNoServerAnswers) {
  testing::internal::CaptureStderr();
  const std::string error = error_of("tcpq://127.0.0.1:1");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_NE(error.find("no LCM server answers at 127.0.0.1:1: Connection refused"),
            std::string::npos)
      << error;
  EXPECT_NE(error_of("tcpq://127.0.0.1:many").find("no LCM server answers"), std::string::npos);
}

// In a network of its own, whose loopback is down: no multicast route, as on a fresh container.
TEST(LcmTransport, WithoutAMulticastRouteSaysWhatToType) {
  int message[2];
  ASSERT_EQ(pipe(message), 0);
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    if (unshare(CLONE_NEWUSER | CLONE_NEWNET) != 0) _exit(2);
    const std::string error = error_of(PortLock::acquire().lcm_url());
    _exit(write(message[1], error.data(), error.size()) > 0 ? 0 : 3);
  }
  close(message[1]);
  std::string error;
  char buffer[512];
  for (ssize_t size; (size = read(message[0], buffer, sizeof buffer)) > 0;) {
    error.append(buffer, static_cast<std::size_t>(size));
  }
  close(message[0]);
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  if (WEXITSTATUS(status) == 2) {
    GTEST_SKIP() << "this user may not make a network namespace, so nothing was tested";
  }
  EXPECT_NE(error.find("ip route add 224.0.0.0/4 dev lo"), std::string::npos) << error;
}

}  // namespace
}  // namespace nextview

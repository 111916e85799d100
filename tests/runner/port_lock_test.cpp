#include "runner/port_lock.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <string>

namespace nextview {
namespace {

// A range of this process alone, outside that of runs and of the system's own choice (from 32768):
// the tests of this file run side by side, each in a process of its own, and so may two checkouts'
// tests.
const int kFirst = 10000 + 3 * (::getpid() % 7000);
const int kLast = kFirst + 2;

FileDescriptor bound_udp_socket(int port) {
  FileDescriptor socket(::socket(AF_INET, SOCK_DGRAM, 0));
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_ANY);
  if (::bind(socket.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    return {};
  }
  return socket;
}

TEST(PortLock, GivesEveryoneAPortOfTheirOwn) {
  const PortLock a = PortLock::acquire(kFirst, kLast);
  const PortLock b = PortLock::acquire(kFirst, kLast);
  EXPECT_EQ(a.port(), kFirst);
  EXPECT_EQ(b.port(), kFirst + 1);
}

TEST(PortLock, GivesAPortBack) {
  { const PortLock a = PortLock::acquire(kFirst, kLast); }
  EXPECT_EQ(PortLock::acquire(kFirst, kLast).port(), kFirst);
}

TEST(PortLock, PassesOverPortsThatOthersHaveBound) {
  const FileDescriptor other = bound_udp_socket(kFirst);
  ASSERT_TRUE(other);
  EXPECT_EQ(PortLock::acquire(kFirst, kLast).port(), kFirst + 1);
}

TEST(PortLock, SaysSoWhenNoneIsFree) {
  const PortLock a = PortLock::acquire(kFirst, kFirst);
  try {
    PortLock::acquire(kFirst, kFirst);
    FAIL() << "the port was given away twice";
  } catch (const NoFreePort& error) {
    const std::string port = std::to_string(kFirst);
    EXPECT_NE(std::string(error.what()).find("no free UDP port from " + port + " to " + port),
              std::string::npos);
    EXPECT_NE(std::string(error.what()).find("--lcm-url"), std::string::npos);
  }
}

TEST(PortLock, NamesItsUrl) {
  EXPECT_TRUE(
      PortLock::acquire(kFirst, kLast)
          .lcm_url()
          .starts_with("udpm://239.255.76.67:" + std::to_string(kFirst) + "?ttl=0&recv_buf_size="));
}

}  // namespace
}  // namespace nextview

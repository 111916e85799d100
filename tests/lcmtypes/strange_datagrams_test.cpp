// Datagrams of strangers, sent to the port of a run.

#include <gtest/gtest.h>
#include <linux/if_packet.h>
#include <net/if.h>
#include <netinet/ip.h>
#include <netinet/udp.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <iostream>

#include "lcmtypes/bus.h"
#include "lcmtypes/lcm_transport.h"
#include "lcmtypes/udpm_reader.h"
#include "runner/port_lock.h"
#include "runner/private_network.h"
#include "tests/lcmtypes/examples.h"
#include "tests/lcmtypes/raw_datagrams.h"

namespace nextview {
namespace {

using std::chrono::milliseconds;

void listen_until(Bus& bus, const std::function<bool()>& there) {
  for (int i = 0; i < 500 && !there(); ++i) bus.handle(milliseconds(20));
}

TEST(StrangeDatagrams, OfFragmentsAreRefusedAndTheBusGoesOn) {
  const PortLock port = PortLock::acquire();
  Bus planner(port.lcm_url(), 7, "planner");
  Bus mapper(port.lcm_url(), 7, "mapper");
  int received = 0;
  mapper.on<goal_t>([&](const goal_t&) { ++received; });
  const RawSender stranger(port.lcm_url());
  testing::internal::CaptureStderr();
  for (const auto& fragment : crafted_fragments()) ASSERT_TRUE(stranger.send(fragment));
  ASSERT_TRUE(stranger.send(lcm_datagram("", {1, 2, 3})));
  ASSERT_TRUE(stranger.send(std::vector<std::uint8_t>(2000, 'L')));
  planner.publish(example<goal_t>());
  listen_until(mapper, [&] { return received == 1; });
  const std::string lines = testing::internal::GetCapturedStderr();
  EXPECT_EQ(received, 1);
  EXPECT_EQ(mapper.counters().refused, 4);
  EXPECT_NE(lines.find("mapper: dropped 2 messages: a fragment of a larger message"),
            std::string::npos)
      << lines;
  EXPECT_NE(lines.find("a channel without a name"), std::string::npos) << lines;
}

// What is not looked at does not pile up in memory without a bound, and what was there first
// counts.
TEST(StrangeDatagrams, InAFloodAreRefusedBeyondABound) {
  const PortLock port = PortLock::acquire();
  Bus mapper(port.lcm_url(), 7, "mapper");
  int received = 0;
  mapper.on<status_t>([&](const status_t&) { ++received; });
  const RawSender stranger(port.lcm_url());
  const auto large = lcm_datagram("NEXTVIEW_STATUS", std::vector<std::uint8_t>(60000));
  const std::size_t sent = 4 * UdpmReader::kMostWaiting / large.size();
  for (std::size_t i = 0; i < sent; ++i) ASSERT_TRUE(stranger.send(large));
  testing::internal::CaptureStderr();
  while (mapper.handle(milliseconds(200))) {
  }
  const std::string lines = testing::internal::GetCapturedStderr();
  EXPECT_EQ(received, 0);
  // All that was kept cannot be right either.
  EXPECT_GT(mapper.counters().refused, 0);
  EXPECT_LE(std::count(lines.begin(), lines.end(), '\n'), 2 * DropLines::kAtOnce) << lines;
}

/// An IP packet of a machine at 10.9.8.7 with a datagram for a multicast group.
std::vector<std::uint8_t> packet_from_outside(const UdpmPlace& place,
                                              const std::vector<std::uint8_t>& datagram) {
  iphdr ip{};
  ip.version = 4;
  ip.ihl = 5;
  ip.ttl = 1;
  ip.protocol = IPPROTO_UDP;
  ip.tot_len = htons(static_cast<std::uint16_t>(sizeof(iphdr) + sizeof(udphdr) + datagram.size()));
  ip.saddr = htonl(0x0a090807);
  ip.daddr = place.socket_address().sin_addr.s_addr;
  std::uint32_t sum = 0;
  std::uint16_t words[sizeof ip / 2];
  std::memcpy(words, &ip, sizeof ip);
  for (const std::uint16_t word : words) sum += word;
  while (sum >> 16 != 0) sum = (sum & 0xffff) + (sum >> 16);
  ip.check = static_cast<std::uint16_t>(~sum);
  udphdr udp{};
  udp.source = htons(5555);
  udp.dest = place.socket_address().sin_port;
  udp.len = htons(static_cast<std::uint16_t>(sizeof(udphdr) + datagram.size()));
  std::vector<std::uint8_t> packet;
  const auto append = [&packet](const auto& part) {
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(&part);
    packet.insert(packet.end(), bytes, bytes + sizeof part);
  };
  append(ip);
  append(udp);
  packet.insert(packet.end(), datagram.begin(), datagram.end());
  return packet;
}

/// Puts a packet on a wire of this namespace.
bool put_on_wire(const char* interface, const std::vector<std::uint8_t>& packet) {
  const int fd = socket(AF_PACKET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_ll to{};
  to.sll_family = AF_PACKET;
  to.sll_protocol = htons(0x0800);
  to.sll_ifindex = static_cast<int>(if_nametoindex(interface));
  to.sll_halen = 6;
  const std::uint8_t group[6] = {0x01, 0x00, 0x5e, 0x7f, 0x4c, 0x43};  // of 239.255.76.67
  std::copy_n(group, 6, to.sll_addr);
  const bool sent =
      sendto(fd, packet.data(), packet.size(), 0, reinterpret_cast<const sockaddr*>(&to),
             sizeof to) == static_cast<ssize_t>(packet.size());
  close(fd);
  return sent;
}

constexpr int kNotPermitted = 42;

/// In a namespace whose network is a wire to a stranger: how many goals of his a bus takes, and of
/// its own run's.
int goals_heard(const std::string& lcm_url) {
  if (!enter_private_network().empty()) return kNotPermitted;
  const char* set_up =
      "ip link add here type veth peer name there && ip addr add 10.9.8.1/24 dev here && "
      "ip link set here up && ip link set there up && ip route replace 224.0.0.0/4 dev here";
  if (std::system(set_up) != 0) return kNotPermitted;
  Bus planner(lcm_url, 7, "planner");
  Bus mapper(lcm_url, 7, "mapper");
  int views = 0;
  mapper.on<goal_t>([&](const goal_t& goal) { views += goal.view; });
  goal_t goal = example<goal_t>();
  goal.run = 7;
  goal.view = 10;
  const auto packet = packet_from_outside(
      parse_udpm_url(lcm_url), lcm_datagram(std::string(Channel<goal_t>::name), encode(goal)));
  if (!put_on_wire("there", packet)) return kNotPermitted;
  goal.view = 1;
  planner.publish(goal);
  // Both are there in the end, in whichever order.
  listen_until(mapper,
               [&] { return views % 10 == 1 && views / 10 + mapper.counters().refused == 1; });
  return views;
}

int in_a_process(const std::function<int()>& work) {
  const pid_t child = fork();
  if (child == 0) _exit(work());
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(StrangeDatagrams, FromAnotherMachineAreNotHeardWhereNothingIsSentToAny) {
  const std::string group = "udpm://239.255.76.67:7690";
  const int heard = in_a_process([&] { return goals_heard(group + "?ttl=0"); });
  if (heard == kNotPermitted) {
    GTEST_SKIP() << "this user may not make a network namespace with a wire, so nothing was tested";
  }
  EXPECT_EQ(heard, 1) << "its own run's only, and the stranger's refused";
  EXPECT_EQ(in_a_process([&] { return goals_heard(group + "?ttl=1"); }), 11)
      << "both, in a run that is spread over hosts";
}

}  // namespace
}  // namespace nextview

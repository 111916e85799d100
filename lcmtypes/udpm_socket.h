#pragma once

#include <netinet/in.h>

#include <string>

namespace nextview {

/// Where an LCM udpm URL meets: udpm://[address[:port]][?ttl=N&recv_buf_size=N].
struct UdpmPlace {
  std::string address = "239.255.76.67";
  int port = 7667;
  int ttl = 0;            ///< 0: nothing leaves this machine
  int recv_buf_size = 0;  ///< bytes the kernel keeps of what is not read yet; 0: as it likes
  sockaddr_in socket_address() const;
};

/// @param lcm_url empty: LCM's default group and port
/// @throws BusError when it is no udpm URL of a multicast group
UdpmPlace parse_udpm_url(const std::string& lcm_url);
/// Whether it is one for parse_udpm_url, and not of another of LCM's providers.
bool is_udpm_url(const std::string& lcm_url);

/// A UDP socket that hears what is sent to a multicast group and port, beside others that do, and
/// nothing that is sent to the port alone.
class UdpmSocket {
 public:
  /// @throws BusError saying why there can be none and what to type
  explicit UdpmSocket(const UdpmPlace& place);
  UdpmSocket(const UdpmSocket&) = delete;
  UdpmSocket& operator=(const UdpmSocket&) = delete;
  ~UdpmSocket();

  int fd() const { return fd_; }

 private:
  int fd_;
};

/// @throws BusError that what cannot be done with the group, for the reason in errno
[[noreturn]] void fail_on_udpm(const std::string& what, const UdpmPlace& place);

}  // namespace nextview

#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <memory>

#include "viewer/outbox.h"

namespace nextview {

/// The file descriptor of a TCP socket that listens on 127.0.0.1, of whatever network.
struct ListeningSocket {
  int fd;
};

/// Serves the page and, at /socket, what it shows. Bound to 127.0.0.1, for pages of its own only
/// (access.h). One thread serves everybody.
class ViewServer {
 public:
  /// @param runs must outlive this
  /// @param page the folder the page was built in
  /// @param port 0: any that is free
  /// @throws std::runtime_error when the port cannot be had
  ViewServer(std::deque<ServedRun>& runs, const std::filesystem::path& page, std::uint16_t port);
  /// On a socket of somebody else's, which it takes over.
  /// @throws std::runtime_error when it is none
  ViewServer(std::deque<ServedRun>& runs, const std::filesystem::path& page,
             ListeningSocket socket);
  ~ViewServer();

  std::uint16_t port() const;
  /// Serves until stop() is called.
  void serve();
  /// May be called from any thread.
  void stop();
  /// SIGINT, SIGTERM and SIGHUP stop it.
  void end_on_signals();
  /// Something has changed in a run. May be called from any thread, as often as one likes.
  void notify();

  struct State;  ///< hides Boost's headers

 private:
  void start();

  std::unique_ptr<State> state_;
};

}  // namespace nextview

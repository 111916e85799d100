#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "runner/child_process.h"

namespace nextview {

/// nextview_viewer beside a run. The run does not depend on it: it may end at any time.
class ViewerProcess {
 public:
  static constexpr const char* kRole = "viewer";  ///< on the bus

  /// @param key_file of the run; empty: it has none
  /// @param paused  the run is to wait for the page
  /// @param listening  a socket for the page (RunNetwork); -1: the viewer opens one
  /// @throws SetupError when it is not there
  ViewerProcess(const std::string& lcm_url, std::int64_t run, const std::string& key_file,
                bool paused, int listening);

  /// Looks whether it still runs, and takes in what it says.
  bool running();
  /// What it has said since the last call, its address first; at last how it ended.
  std::vector<std::string> take_lines();
  /// Of its page, as it said.
  const std::string& address() const { return address_; }

 private:
  ChildProcess process_;
  std::string address_;
  bool end_told_ = false;
};

}  // namespace nextview

#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "lcmtypes/channels.h"

namespace nextview {

/// The CAD model a run is simulated in, for the page: loaded when somebody asks for it, in a thread
/// of its own.
class CadModel {
 public:
  /// u32 triangles, f32 x 3 per vertex, u32 x 3 per triangle; the number of vertices stands in the
  /// message's head.
  struct Mesh {
    std::uint32_t vertices = 0;
    std::vector<std::uint8_t> bytes;
  };
  struct Answer {
    bool there = false;
    std::shared_ptr<const Mesh> mesh;  ///< nothing: it cannot be had
    std::string failure;               ///< why not
  };

  /// Starts loading, unless that has been done. `done` is called, from another thread, when there
  /// is an answer.
  void load(const run_config_t& config, std::function<void()> done);
  Answer answer() const;
  /// Gives up loading: `done` is not called from here on.
  void cancel() { loader_ = {}; }

 private:
  void set(Answer answer);

  mutable std::mutex mutex_;
  Answer answer_;
  std::jthread loader_;
};

}  // namespace nextview

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "viewer/outbox.h"

namespace nextview {

/// As the page reads its numbers: little-endian.
template <class Number>
Number number_at(const std::vector<std::uint8_t>& bytes, std::size_t at) {
  Number number;
  std::memcpy(&number, bytes.data() + at, sizeof number);
  return number;
}

/// What a page holds of one run after the messages it was sent.
class PageModel {
 public:
  explicit PageModel(int run = 0) : run_(run) {}

  void take(const Outbox::Message& message);
  /// Takes messages, saying so, until there is none; how many.
  int drain(Outbox& outbox);

  /// Of the surface voxels: Occupied or OcclusionPlane, normal and quality as sent.
  struct Voxel {
    bool plane;
    std::array<std::int8_t, 3> normal;
    std::uint8_t quality;
    bool operator==(const Voxel&) const = default;
  };
  std::map<std::array<int, 3>, Voxel> voxels() const;

  std::map<std::array<int, 3>, std::vector<std::uint8_t>> blocks;
  nlohmann::json facts;
  std::vector<nlohmann::json> rows;
  int view = -1;  ///< that was said to be there in full
  int scan_view = 0;
  std::vector<std::uint8_t> scan;
  std::uint32_t tried = 0;
  nlohmann::json next;
  std::uint32_t cad_vertices = 0;
  std::int64_t messages = 0;
  std::size_t bytes = 0;  ///< of all messages

 private:
  int run_;
};

/// Lets somebody answer the page: nobody.
inline void nobody() {}

}  // namespace nextview

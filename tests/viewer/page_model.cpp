#include "tests/viewer/page_model.h"

#include "viewer/surface_blocks.h"

namespace nextview {

void PageModel::take(const Outbox::Message& message) {
  ++messages;
  const std::vector<std::uint8_t>& sent = message.bytes;
  bytes += sent.size();
  if (!message.binary) {
    const auto json = nlohmann::json::parse(sent.begin(), sent.end());
    if (json.at("run") != run_) return;
    if (json.at("kind") == "facts") facts = json.at("facts");
    if (json.at("kind") == "shown") view = json.at("view");
    if (json.at("kind") == "next") next = json.at("next");
    if (json.at("kind") == "rows") {
      rows.resize(json.at("first").get<std::size_t>() - 1);
      for (const auto& row : json.at("rows")) rows.push_back(row);
    }
    return;
  }
  if (sent.at(1) != run_) return;
  const auto of_view = number_at<std::uint32_t>(sent, 4);
  const auto count = number_at<std::uint32_t>(sent, 8);
  std::size_t at = 12;
  switch (sent.at(0)) {
    case 1:
      for (std::uint32_t block = 0; block < count; ++block) {
        const std::array<int, 3> coordinate = {number_at<std::int16_t>(sent, at),
                                               number_at<std::int16_t>(sent, at + 2),
                                               number_at<std::int16_t>(sent, at + 4)};
        const std::size_t size = kSurfaceVoxelBytes * number_at<std::uint16_t>(sent, at + 6);
        const auto first = sent.begin() + static_cast<std::ptrdiff_t>(at + 8);
        blocks[coordinate].assign(first, first + static_cast<std::ptrdiff_t>(size));
        at += 8 + size;
      }
      break;
    case 2:
      scan_view = static_cast<int>(of_view);
      scan.assign(sent.begin() + 12, sent.end());
      break;
    case 3:
      tried = count;
      break;
    default:
      cad_vertices = count;
  }
}

int PageModel::drain(Outbox& outbox) {
  int taken = 0;
  static constexpr const char* kAll = R"({"got": 1000000000})";
  for (outbox.take(kAll, nobody);; outbox.take(kAll, nobody)) {
    const auto message = outbox.next();
    if (!message) return taken;
    take(*message);
    ++taken;
  }
}

std::map<std::array<int, 3>, PageModel::Voxel> PageModel::voxels() const {
  std::map<std::array<int, 3>, Voxel> voxels;
  for (const auto& [block, held] : blocks) {
    for (std::size_t at = 0; at < held.size(); at += kSurfaceVoxelBytes) {
      const auto word = number_at<std::uint32_t>(held, at);
      const int place = static_cast<int>(word & 511U);
      voxels[{8 * block[0] + place % 8, 8 * block[1] + place / 8 % 8, 8 * block[2] + place / 64}] =
          {(word & kOcclusionPlaneBit) != 0,
           {number_at<std::int8_t>(held, at + 4), number_at<std::int8_t>(held, at + 5),
            number_at<std::int8_t>(held, at + 6)},
           held[at + 7]};
    }
  }
  return voxels;
}

}  // namespace nextview

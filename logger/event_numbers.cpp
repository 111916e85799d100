#include "logger/event_numbers.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <fstream>

#include "logger/log_reader.h"

namespace nextview {
namespace {

// Of an event's header, all big-endian: sync word, number, time, length of the channel, of the
// data.
constexpr std::size_t kHeaderBytes = 28;
constexpr std::size_t kNumberAt = 4;
constexpr std::size_t kNumberBytes = 8;
constexpr std::size_t kLengthsAt = 20;
constexpr std::uint64_t kSyncWord = 0xEDA1DA01;

using Header = std::array<char, kHeaderBytes>;

std::uint64_t big_endian(const Header& header, std::size_t at, std::size_t bytes) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < bytes; ++i) {
    value = value << 8 | static_cast<unsigned char>(header[at + i]);
  }
  return value;
}

std::array<char, kNumberBytes> as_big_endian(std::uint64_t value) {
  std::array<char, kNumberBytes> bytes{};
  for (auto byte = bytes.rbegin(); byte != bytes.rend(); ++byte, value >>= 8) {
    *byte = static_cast<char>(value & 0xFF);
  }
  return bytes;
}

}  // namespace

void number_events(const std::filesystem::path& file) {
  std::fstream log(file, std::ios::in | std::ios::out | std::ios::binary);
  if (!log) throw LogError(file.string() + ": cannot be changed");
  const std::uint64_t size = std::filesystem::file_size(file);
  std::uint64_t at = 0;
  for (std::uint64_t number = 0; at + kHeaderBytes <= size; ++number) {
    Header header{};
    log.seekg(static_cast<std::streamoff>(at));
    if (!log.read(header.data(), header.size())) break;
    if (big_endian(header, 0, kNumberAt) != kSyncWord) break;
    if (big_endian(header, kNumberAt, kNumberBytes) != number) {
      const auto bytes = as_big_endian(number);
      log.seekp(static_cast<std::streamoff>(at + kNumberAt));
      log.write(bytes.data(), bytes.size());
    }
    at += kHeaderBytes + big_endian(header, kLengthsAt, 4) + big_endian(header, kLengthsAt + 4, 4);
  }
  if (!log.flush()) throw LogError(file.string() + ": cannot be written to");
}

}  // namespace nextview

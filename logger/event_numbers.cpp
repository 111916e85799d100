#include "logger/event_numbers.h"

#include <cstdint>
#include <fstream>

#include "logger/log_event.h"
#include "logger/log_reader.h"

namespace nextview {

void number_events(const std::filesystem::path& file) {
  std::fstream log(file, std::ios::in | std::ios::out | std::ios::binary);
  if (!log) throw LogError(file.string() + ": cannot be changed");
  LogReader reader(file);
  std::uint64_t number = 0;
  while (const auto event = reader.next()) {
    if (event->number != number) {
      const auto numbered =
          encode_event({.number = number, .received_us = event->received_us}, "", {});
      const std::size_t size = kEventHeaderBytes + event->channel.size() + event->bytes.size();
      constexpr std::size_t kNumberBytes = 8;
      log.seekp(static_cast<std::streamoff>(reader.position()) - static_cast<std::streamoff>(size) +
                static_cast<std::streamoff>(kSyncWordBytes));
      log.write(reinterpret_cast<const char*>(numbered.data()) + kSyncWordBytes, kNumberBytes);
    }
    ++number;
  }
  if (!log.flush()) throw LogError(file.string() + ": cannot be written to");
}

}  // namespace nextview

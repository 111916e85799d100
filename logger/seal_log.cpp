#include "logger/seal_log.h"

#include <fstream>
#include <system_error>

#include "lcmtypes/decode.h"
#include "logger/log_event.h"

namespace nextview {

void seal_log(const RunLog& log) {
  const auto& stop = log.record().stop();
  if (!stop || log.contents().is_sealed(stop->run) || log.bytes_left() > 0) return;
  std::vector<std::uint8_t> seal = encode(log.contents().seal(stop->run, stop->utime));
  if (log.key()) log.key()->sign(Channel<seal_t>::name, seal);
  const auto event = encode_event(
      {.number = log.contents().events(), .received_us = log.contents().last_received_us()},
      Channel<seal_t>::name, seal);
  const std::uintmax_t size = std::filesystem::file_size(log.file());
  std::ofstream to(log.file(), std::ios::binary | std::ios::app);
  to.write(reinterpret_cast<const char*>(event.data()), static_cast<std::streamsize>(event.size()));
  if (to.flush()) return;
  std::error_code ignored;
  std::filesystem::resize_file(log.file(), size, ignored);
  throw LogError(log.file().string() + ": cannot be sealed: cannot be written to");
}

}  // namespace nextview

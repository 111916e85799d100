// The bytes of a log: read to its end, cut off, and held against its seal.
#include "logger/run_log.h"
#include "tests/fuzz/fuzz_input.h"

namespace nextview {
namespace {

std::int64_t read_events(LogReader& reader) {
  std::int64_t bytes = 0;
  while (const auto event = reader.next()) {
    bytes += static_cast<std::int64_t>(event->channel.size() + event->bytes.size());
  }
  return bytes;
}

}  // namespace
}  // namespace nextview

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace nextview;
  static FuzzFile file("run.lcmlog");
  const auto& path = file.hold(FuzzInput(bytes, size));
  RunLog log(path, std::nullopt, RangeImages::Keep);
  log.read_on();
  const std::int64_t run = log.record().config() ? log.record().config()->run : 0;
  (void)log.contents().faults(run);
  if (log.record().config()) (void)log.record().missing();
  LogReader reader(path);
  std::int64_t accounted = read_events(reader) + reader.bytes_left();
  for (const DamagedBytes& damaged : reader.damaged()) accounted += damaged.bytes;
  demand(accounted <= static_cast<std::int64_t>(size), "no byte is read twice");
  reader.cut_rest();
  demand(reader.bytes_left() == 0, "nothing is left behind what was cut off");
  return 0;
}

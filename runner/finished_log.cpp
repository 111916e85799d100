#include "runner/finished_log.h"

#include "logger/event_numbers.h"
#include "logger/seal_log.h"

namespace nextview {

std::vector<std::string> finish_log(RunLog& log, const std::filesystem::path& file,
                                    bool began_anew) {
  // A recorder that was killed just now leaves half a message, and no more than that is cut off.
  constexpr std::int64_t kLongestEvent = 64 * 1024;
  std::vector<std::string> said;
  try {
    log.read_on();
    if (log.bytes_left() <= kLongestEvent) log.cut_rest();
    seal_log(log);
    if (!began_anew) return said;
    number_events(file);
    for (const std::string& what : log.contradictions()) {
      said.push_back("warning: who was started again says otherwise: " + what);
    }
  } catch (const LogError& error) {
    said.emplace_back(error.what());
  }
  return said;
}

}  // namespace nextview

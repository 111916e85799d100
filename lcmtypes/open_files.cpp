#include "lcmtypes/open_files.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>

namespace nextview {

std::string too_few_open_files(int wanted) {
  const auto enough = static_cast<rlim_t>(wanted);
  rlimit limit{};
  ::getrlimit(RLIMIT_NOFILE, &limit);
  if (limit.rlim_cur >= enough) return {};
  const rlim_t had = limit.rlim_cur;
  limit.rlim_cur = std::min(enough, limit.rlim_max);
  if (limit.rlim_cur >= enough && ::setrlimit(RLIMIT_NOFILE, &limit) == 0) return {};
  return fmt::format(
      "{} open files are allowed, and up to {} are needed; type, in a new shell or as root: "
      "ulimit -n 1024",
      had, wanted);
}

}  // namespace nextview

#include "reports/progress.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

namespace nextview {
namespace {

constexpr int kBarWidth = 30;

std::string numbers_of(const ViewRow& row) {
  // Until it is known what can be seen at all, and with --no-coverage always.
  const std::string coverage =
      row.surface_coverage ? fmt::format("{:.3f}", *row.surface_coverage) : "unknown";
  std::string decided;
  if (!row.chosen()) {
    decided = "start";
  } else if (row.plan_s) {
    decided = fmt::format("decided in {:.1f} ms", 1e3 * *row.plan_s);
  }
  return fmt::format("coverage {}  quality {:.3f}  {}", coverage, row.commit.mean_quality, decided);
}

}  // namespace

Progress::Progress(std::ostream& out, Style style, int max_views)
    : out_(out), style_(style), max_views_(max_views) {}

void Progress::show(const ViewRow& row) {
  const std::string line = fmt::format("view {:3}/{}  {}", row.view, max_views_, numbers_of(row));
  if (style_ == Style::Lines) {
    out_ << line << std::endl;
    return;
  }
  const int full = kBarWidth * row.view / std::max(max_views_, 1);
  bar_ = "\r\033[K[" + std::string(static_cast<std::size_t>(full), '#') +
         std::string(static_cast<std::size_t>(kBarWidth - full), '.') + "] " + line;
  out_ << bar_ << std::flush;
}

void Progress::say(const std::string& line) {
  if (!bar_.empty()) out_ << "\r\033[K";
  out_ << line << '\n' << bar_ << std::flush;
}

void Progress::finish() {
  if (!bar_.empty()) out_ << std::endl;
  bar_.clear();
}

}  // namespace nextview

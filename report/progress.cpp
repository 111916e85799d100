#include "report/progress.h"

#include <algorithm>
#include <cstdio>
#include <optional>

namespace nextview {
namespace {

constexpr int kBarWidth = 30;

std::string numbers_of(const ViewRow& row) {
  // Until it is known what can be seen at all, and with --no-coverage always.
  char coverage[32] = "unknown";
  if (row.surface_coverage) {
    std::snprintf(coverage, sizeof coverage, "%.3f", *row.surface_coverage);
  }
  char decided[48] = "";
  if (!row.chosen()) {
    std::snprintf(decided, sizeof decided, "start");
  } else if (row.plan_s) {
    std::snprintf(decided, sizeof decided, "decided in %.1f ms", 1e3 * *row.plan_s);
  }
  char text[160];
  std::snprintf(text, sizeof text, "coverage %s  quality %.3f  %s", coverage,
                row.commit.mean_quality, decided);
  return text;
}

}  // namespace

Progress::Progress(std::ostream& out, Style style, int max_views)
    : out_(out), style_(style), max_views_(max_views) {}

void Progress::show(const ViewRow& row) {
  char view[64];
  std::snprintf(view, sizeof view, "view %3d/%d  ", row.view, max_views_);
  const std::string line = view + numbers_of(row);
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

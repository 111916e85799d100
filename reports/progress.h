#pragma once

#include <ostream>
#include <string>

#include "reports/view_rows.h"

namespace nextview {

/// What a person sees while a run goes on: one line a view, or on a terminal one bar that moves.
class Progress {
 public:
  enum class Style { Lines, Bar };

  /// The stream must outlive the object.
  Progress(std::ostream& out, Style style, int max_views);

  void show(const ViewRow& row);
  /// A line of its own, whatever the bar is doing.
  void say(const std::string& line);
  /// Leaves the cursor on a new line.
  void finish();

 private:
  std::ostream& out_;
  Style style_;
  int max_views_;
  std::string bar_;  ///< what stands on the line the cursor is on
};

}  // namespace nextview

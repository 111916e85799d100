#pragma once

#include "bench/conditions.h"

namespace nextview {

/// Each checks that what it compares gives the same answers, then registers its benchmarks.
void register_view_evaluation(const BenchOptions& options);
void register_map_update(const BenchOptions& options);
void register_decision(const BenchOptions& options);
void register_scan(const BenchOptions& options);
void register_bus(const BenchOptions& options);

}  // namespace nextview

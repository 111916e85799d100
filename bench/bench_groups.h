#pragma once

#include "bench/conditions.h"

namespace nextview {

/// Each registers its benchmarks. All but the bus, which is only timed, first report how often the
/// answers of what they compare agree, and throw where they have to be the same and are not.
void register_view_evaluation(const BenchOptions& options);
void register_map_update(const BenchOptions& options);
void register_decision(const BenchOptions& options);
void register_scan(const BenchOptions& options);
void register_bus(const BenchOptions& options);

}  // namespace nextview

#pragma once

#include <string_view>
#include <vector>

#include "planner/paper_refined_strategy.h"
#include "planner/paper_strategy.h"
#include "planner/paper_tidy_up_strategy.h"
#include "planner/prediction/orientations.h"
#include "planner/prediction/view_predictor.h"
#include "planner/surface_strategy.h"
#include "planner/termination.h"

namespace nextview {

/// What a strategy may be made of. A strategy takes what it needs of it; where the robot may be is
/// in `search`, in `surface` and in `tidy_up`.
struct StrategyInputs {
  double voxel_size_m = 0.10;             ///< of the map
  PredictionRaster raster;                ///< the rays a view is predicted with
  PredictionRaster coarse_raster;         ///< the same with a sixteenth of the rays
  int subdivisions = 0;                   ///< of an icosahedron's faces, whose centres are the ...
  std::vector<Orientation> orientations;  ///< ... orientations a view is chosen among
  int threads = 1;                        ///< of no influence on the results
  PlannerParameters search;               ///< of a simplex
  StopParameters stop;                    ///< the paper's rules
  SurfaceParameters surface;              ///< of what looks for surface
  TidyUpParameters tidy_up;               ///< of what looks for holes
};

/// The strategy of that name.
/// @throws std::invalid_argument when there is none, or for parameters that cannot be
std::unique_ptr<Strategy> make_strategy(std::string_view name, const StrategyInputs& inputs);

}  // namespace nextview

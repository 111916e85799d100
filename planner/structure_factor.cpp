#include "planner/structure_factor.h"

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace nextview {

double structure_factor(const ViewCounts& counts) {
  const NormalScatter& sum = counts.normals;
  const auto trace = static_cast<double>(sum.xx + sum.yy + sum.zz);
  if (trace == 0.0) return 0.0;
  const auto share = [trace](std::int64_t element) { return static_cast<double>(element) / trace; };
  Eigen::Matrix3d scatter;
  scatter << share(sum.xx), share(sum.xy), share(sum.xz),  //
      share(sum.xy), share(sum.yy), share(sum.yz),         //
      share(sum.xz), share(sum.yz), share(sum.zz);
  // The iterative solver, for the direct one asks the C library for angles, which differ between
  // machines.
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(scatter, Eigen::EigenvaluesOnly);
  return std::clamp(3.0 * solver.eigenvalues().minCoeff(), 0.0, 1.0);
}

}  // namespace nextview

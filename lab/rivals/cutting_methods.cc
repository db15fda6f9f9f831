// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/rivals/cutting_methods.h"

#include "plumbline/line_cutting/cut_lines.h"
#include "plumbline/line_cutting/pose_information.h"
#include "plumbline/line_cutting/ratio_ascent.h"

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace plumbline {
namespace {

constexpr int kMaxSweeps = 20;
// Sweeps end when one raises log det by less than this.
constexpr double kSweepTolerance = 1e-4;
// Fewer lines than this do not fix a pose, so that drop leaves at least as many.
constexpr std::size_t kMinLinesKept = 4;

using Cuts = std::vector<LineCut>;

Cuts CutInSweeps(const CuttingProblem& problem, CuttingInformation information) {
  Cuts cuts(problem.lines.size());
  if (CutEachLine(problem, information, cuts) < kSweepTolerance) return cuts;
  for (int sweep = 1; sweep < kMaxSweeps; ++sweep) {
    Cuts better = cuts;
    const double gain = CutEachLine(problem, information, better);
    // The printed information grows without bound if it becomes singular, so that log det is
    // computed anew from the cuts.
    const double before = LogDeterminantOf(problem, cuts, information);
    if (!(LogDeterminantOf(problem, better, information) >= before)) break;
    cuts = std::move(better);
    if (gain < kSweepTolerance) break;
  }
  return cuts;
}

Cuts CutsOf(const Eigen::VectorXd& ratios) {
  Cuts cuts(static_cast<std::size_t>(ratios.size() / 2));
  for (std::size_t i = 0; i < cuts.size(); ++i) {
    const Eigen::Vector2d pair = ratios.segment<2>(2 * static_cast<Eigen::Index>(i));
    cuts[i] = {pair.minCoeff(), pair.maxCoeff()};
  }
  return cuts;
}

Cuts CutJointly(const CuttingProblem& problem, CuttingInformation information) {
  const auto size = static_cast<Eigen::Index>(problem.lines.size());
  Eigen::VectorXd full(2 * size);
  for (Eigen::Index i = 0; i < size; ++i) full.segment<2>(2 * i) << 0, 1;
  const auto objective = [&](const Eigen::VectorXd& ratios, Eigen::VectorXd& gradient) {
    Cuts cuts(problem.lines.size());
    for (std::size_t i = 0; i < cuts.size(); ++i) {
      const auto k = 2 * static_cast<Eigen::Index>(i);
      cuts[i] = {ratios(k), ratios(k + 1)};
    }
    return LogDeterminantOf(problem, cuts, information, &gradient);
  };
  return CutsOf(Ascend<Eigen::Dynamic>(objective, full).ratios);
}

// Returns the mean variance of the two residuals of the line at full length.
double Uncertainty(const RectifiedCamera& camera, const CuttableLine& line) {
  const Eigen::Matrix2d weight = CutWeight(camera, line, {}, CuttingInformation::kIndependent);
  return 0.5 * (1 / weight(0, 0) + 1 / weight(1, 1));
}

Cuts DropLines(const CuttingProblem& problem, double share) {
  const std::size_t size = problem.lines.size();
  std::vector<double> uncertainty(size);
  for (std::size_t i = 0; i < size; ++i) {
    uncertainty[i] = Uncertainty(problem.camera, problem.lines[i]);
  }
  std::vector<std::size_t> worst_first(size);
  std::iota(worst_first.begin(), worst_first.end(), std::size_t{0});
  std::stable_sort(worst_first.begin(), worst_first.end(), [&](std::size_t a, std::size_t b) {
    return uncertainty[a] > uncertainty[b];
  });
  const std::size_t kept =
      std::max(std::min(size, kMinLinesKept),
               size - static_cast<std::size_t>(share * static_cast<double>(size)));
  Cuts cuts(size);
  for (std::size_t k = 0; k < size - kept; ++k) cuts[worst_first[k]].used = false;
  return cuts;
}

}  // namespace

std::vector<LineCut> CutLinesBy(const CuttingRecipe& recipe, const CuttingProblem& problem) {
  switch (recipe.method) {
    case CuttingMethod::kNone:
      break;
    case CuttingMethod::kGreedy:
      return CutLines(problem, recipe.information);
    case CuttingMethod::kGreedySweeps:
      return CutInSweeps(problem, recipe.information);
    case CuttingMethod::kJoint:
      return CutJointly(problem, recipe.information);
    case CuttingMethod::kDrop:
      return DropLines(problem, recipe.drop_share);
  }
  return Cuts(problem.lines.size());
}

}  // namespace plumbline

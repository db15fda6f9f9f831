// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/line_cutting/cutting_problem.h"

#include <array>
#include <type_traits>
#include <utility>
#include <vector>

namespace plumbline {

// Search for the cuts of all lines.
enum class CuttingMethod {
  kNone,          // all lines keep their full length
  kGreedy,        // Algorithm 1: one line after the other, once (the product's CutLines)
  kGreedySweeps,  // Algorithm 1 again until nothing changes
  kJoint,         // all ratios at once, gradient ascent from full length
  kDrop,          // drops the most uncertain lines, the others stay whole
};
constexpr auto EnumNames(std::type_identity<CuttingMethod>) {
  return std::array{std::pair{CuttingMethod::kNone, "none"},
                    std::pair{CuttingMethod::kGreedy, "greedy"},
                    std::pair{CuttingMethod::kGreedySweeps, "greedy_sweeps"},
                    std::pair{CuttingMethod::kJoint, "joint"},
                    std::pair{CuttingMethod::kDrop, "drop"}};
}

inline constexpr double kDropShare = 0.3;  // of the lines that drop leaves out; at least 4 stay

// How lines are cut.
struct CuttingRecipe {
  CuttingMethod method = CuttingMethod::kNone;
  CuttingInformation information = CuttingInformation::kIndependent;
  double drop_share = kDropShare;
};

// Returns cuts for all lines, in their order. In the chosen information a cut by greedy_sweeps or
// joint is never worse than full length; greedy and greedy_sweeps depend on the order of the lines.
// BugError as CutLines.
std::vector<LineCut> CutLinesBy(const CuttingRecipe& recipe, const CuttingProblem& problem);

}  // namespace plumbline

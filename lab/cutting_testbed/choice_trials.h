// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/cutting_testbed/scene.h"

#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <type_traits>
#include <utility>

namespace plumbline {

// Methods of choosing a given number of points and lines.
enum class ChoiceVariant {
  kTogether,        // ChooseFeatures with greedy: points and lines with their best cuts
  kTogetherSweeps,  // the same, with the chosen lines cut again
  kChooseThenCut,   // points and whole lines together, then the chosen lines cut
  kApart,           // half the budget for points, half for cut lines, independently
  kWhole,           // points and whole lines together, without cutting
  kRandom,          // random choice, then cut
};
constexpr auto EnumNames(std::type_identity<ChoiceVariant>) {
  return std::array{std::pair{ChoiceVariant::kTogether, "together"},
                    std::pair{ChoiceVariant::kTogetherSweeps, "together_sweeps"},
                    std::pair{ChoiceVariant::kChooseThenCut, "choose_then_cut"},
                    std::pair{ChoiceVariant::kApart, "apart"},
                    std::pair{ChoiceVariant::kWhole, "whole"},
                    std::pair{ChoiceVariant::kRandom, "random"}};
}

struct ChoiceOptions {
  int points = 100;  // 2 to 7 m ahead, measured to 1 to 3 px
  int lines = 30;    // of a stereo scene, disparities known to 5 %
  int budget = 40;   // even
  bool try_all = false;
};

// log det of the pose for each choice, and the best known: of all subsets of that size with their
// lines cut by greedy_sweeps if try_all is set (at most 12 features), otherwise of the variants.
struct ChoiceTrial {
  std::map<ChoiceVariant, double> log_determinant;
  double best = -std::numeric_limits<double>::infinity();
};
ChoiceTrial TryChoices(const ChoiceOptions& options, std::uint64_t index);

}  // namespace plumbline

// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/experiments/figure_list.h"

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace plumbline {

// Reproducible figures, and times.
struct TimedFigures {
  std::vector<FigureRow> figures, times;
};

std::span<const FigureMetric> CuttingTimingMetrics();

// Measures time and gain of cutting 10, 30, 60 and 100 lines of a frame by each method, over
// `repeats` simulated stereo scenes each. Sequences: lines/<count>. nullopt if `progress(done,
// total)` returns false.
std::optional<TimedFigures> TimeCutting(
    int repeats, const std::function<bool(std::size_t, std::size_t)>& progress);

}  // namespace plumbline

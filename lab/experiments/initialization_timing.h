// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/experiments/cutting_timing.h"

namespace plumbline {

std::span<const FigureMetric> InitializationTimingMetrics();

// Measures the times of the parts of initialization by factorization, and the accuracy of its
// camera centres, over `repeats` simulated windows of m = 3 frames with 200, 300 and 500 points
// each, a fifth of them to be interpolated. Sequences: points/<count>. nullopt if `progress(done,
// total)` returns false.
std::optional<TimedFigures> TimeInitialization(
    int repeats, const std::function<bool(std::size_t, std::size_t)>& progress);

}  // namespace plumbline

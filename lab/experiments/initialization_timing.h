// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/experiments/cutting_timing.h"

namespace plumbline {

std::span<const FigureMetric> InitializationTimingMetrics();

// How long the parts of a start by factorization take, and how well it finds the centres of the
// cameras, over `repeats` simulated windows of m = 3 frames with 200, 300 and 500 points each, a
// fifth of them to be interpolated. Sequences: points/<count>. nullopt when `progress(done, total)`
// returns false.
std::optional<TimedFigures> TimeInitialization(
    int repeats, const std::function<bool(std::size_t, std::size_t)>& progress);

}  // namespace plumbline

// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/initialization/window_adjustment.h"
#include "plumbline/initialization/window_tracks.h"

#include <numbers>
#include <vector>

namespace plumbline {

// Solutions nearer to each other than this, radians, are the same.
inline constexpr double kSameRotation = 0.3 * std::numbers::pi / 180;
inline constexpr double kSameDirection = 3 * std::numbers::pi / 180;

// One way to explain a window of frames, and how well it does.
struct Explanation {
  WindowSolution solution;
  WindowFit fit;          // fit of the points
  double cost = 0;        // cost of points and, where they take part, lines
  int lines = 0;          // that fit every view which shows them
  double line_noise = 1;  // noise of the lines, in units of the standard deviation assumed
};

// Whether the newest poses of two solutions are the same, whatever their units.
bool IsSame(const WindowSolution& a, const WindowSolution& b);

// Adds an explanation; of two that are the same the cheaper stays.
void InsertExplanation(Explanation explanation, std::vector<Explanation>& explanations);

void SortByCost(std::vector<Explanation>& explanations);

// Bundle adjustment of all that has a place; fit and cost are those of the points after it.
void AdjustExplanation(const WindowTracks& tracks, Explanation& explanation);

}  // namespace plumbline

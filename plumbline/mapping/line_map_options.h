// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/options.h"

namespace plumbline {

struct LineMapOptions {
  int min_keyframes = 4;             // keyframes that must show each point of a line
  double max_relative_sigma = 0.02;  // deviation of each point of a line, over its distance
  // Share of the keyframes with a line in their image that must show it.
  double min_found_ratio = 0.25;
  // Largest mean chi2 of the segments of a line, of two residuals each.
  double max_mean_chi2 = 5;
  double min_mean_length_px = 35;  // mean length of the segments of a line
};

template <class Visitor>
void VisitFields(Visitor&& visit, LineMapOptions& o) {
  visit("min_keyframes",
        o.min_keyframes,
        "keyframes that must show each point of a line",
        Range{2, 100});
  visit("max_relative_sigma",
        o.max_relative_sigma,
        "largest deviation of each point of a line, relative to its distance from the nearest "
        "keyframe that shows the line",
        Range{0.0001, 1});
  visit(
      "min_found_ratio",
      o.min_found_ratio,
      "of the keyframes that have a line in their image, before it or behind something, the share "
      "that must show it",
      Range{0, 1});
  visit("max_mean_chi2",
        o.max_mean_chi2,
        "largest mean of the chi2 of the segments that show a line; 2 where they are as far off as "
        "their own deviations say",
        Range{0.1, 1000});
  visit("min_mean_length_px",
        o.min_mean_length_px,
        "smallest mean length of the segments that show a line, pixels",
        Range{0, 1000});
}

}  // namespace plumbline

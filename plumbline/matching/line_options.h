// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/options.h"
#include "plumbline/matching/measurements.h"

#include <string>
#include <type_traits>
#include <vector>

namespace plumbline {

// Settings of the triangulation of lines and of their weights in all optimization.
struct LineOptions {
  std::string residual = "observed_ends";
  std::string reconstruction = "n_view";
  LineWeighting weighting = LineWeighting::kCovariance;
  double constant_sigma_px = 1;
  double min_length_ratio = 0.3;
  bool rotation_gate = false;

  LineWeights weights() const { return {weighting, constant_sigma_px}; }
};

template <class Visitor>
void VisitFields(Visitor&& visit, LineOptions& o) {
  visit("residual",
        o.residual,
        "observed_ends: distances of the measured end points from the projected line; "
        "projected_ends: of the projected end points from the measured line (with "
        "tracking.reference last_frame)",
        Methods{{"observed_ends", "projected_ends"}});
  visit("reconstruction",
        o.reconstruction,
        "of a line from several keyframes: n_view (all closest ones together, pairs where they "
        "disagree), n_view_checked (with the first paper's tests of reprojection and of the ends "
        "of pairs)",
        Methods{{"n_view", "n_view_checked"}});
  visit("weighting",
        o.weighting,
        "of the two residuals of a line: none (constant_sigma_px each), scalar (their mean "
        "variance), "
        "covariance (2 x 2, with the uncertainty of the 3D line in tracking)");
  visit("constant_sigma_px",
        o.constant_sigma_px,
        "deviation of the residuals of all lines where weighting is none [px]",
        Range{0.01, 10});
  visit("min_length_ratio",
        o.min_length_ratio,
        "shorter over longer of two lines that are matched by descriptor, between keyframes and "
        "where no pose is predicted (the first paper: 0.8)",
        Range{0, 1});
  visit("rotation_gate",
        o.rotation_gate,
        "lines of two keyframes are matched only where their directions in the images differ by no "
        "more than the keyframes are turned against each other (as the first paper)");
}

inline std::vector<RemovedOption> RemovedOptions(std::type_identity<LineOptions> /*of*/) {
  return {{"parametrization",
           "it is fixed at plucker; other parameters are methods of lines.residual in builds with "
           "the laboratory",
           "plucker"}};
}

}  // namespace plumbline

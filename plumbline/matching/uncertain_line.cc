// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/matching/uncertain_line.h"

namespace plumbline {

Eigen::Matrix4d RegularizedInformation(const Eigen::Matrix4d& information) {
  constexpr double kUnknownLineSigma = 0.5;  // radians
  return information + Eigen::Matrix4d::Identity() / (kUnknownLineSigma * kUnknownLineSigma);
}

UncertainLine::UncertainLine(const PluckerLine& line, const Eigen::Matrix4d& information_of_it)
    : prepared(ToOrthonormal(line)), information(RegularizedInformation(information_of_it)) {}

}  // namespace plumbline

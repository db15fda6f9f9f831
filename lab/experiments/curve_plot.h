// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/report/figure.h"

#include <string>
#include <vector>

#include <Eigen/Core>

namespace plumbline {

struct Curve {
  std::string name;
  std::vector<Eigen::Vector2d> points;  // by x
};

// Curves over one axis. Both axes begin at 0 or below.
struct CurvePanel {
  std::string title, label_x, label_y;
  std::vector<Curve> curves;
  bool dots = false;  // mark the points
  // Ends of the axes; 0: the greatest value.
  double end_x = 0, end_y = 0;
};

// The panels below each other, with one legend: curves of the same name have the same colour.
// Panels without any point are left out.
Figure CurvePlot(const std::vector<CurvePanel>& panels);

}  // namespace plumbline

// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/report/figure.h"

#include <string>

#include <Eigen/Core>

namespace plumbline {

// A function of two ratios in [0, 1] as a field of 12 shades from its 5 % quantile (dark) to its
// greatest value (light), with a cross at `marked`. `values`: row by the second ratio (upwards),
// column by the first (to the right).
Figure SurfacePlot(const Eigen::MatrixXd& values,
                   const Eigen::Vector2d& marked,
                   const std::string& title,
                   const std::string& label_x,
                   const std::string& label_y);

}  // namespace plumbline

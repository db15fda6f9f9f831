// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/ceres_reference/ceres_derivatives.h"
#include "lab/line_rivals/rival_ba.h"
#include "plumbline/geometry/plucker.h"
#include "plumbline/geometry/trimming.h"
#include "plumbline/optimization/problem.h"

#include <memory>

#include <ceres/cost_function.h>

// The residuals of this module as Ceres terms: the reference for tests and measurements of our own
// solvers. In a library of its own (plumbline::ceres_reference), so that nothing else needs Ceres.
// Manifolds are those of ceres_manifolds.h.

namespace plumbline {

// Cost of one observation. Parameter blocks: pose (7) and point (3).
std::unique_ptr<ceres::CostFunction> MakePointCost(const RectifiedCamera& camera,
                                                   const PointMeasurement& measurement,
                                                   CeresDerivatives derivatives);

// Parameter blocks: pose (7) and line (6): OrthonormalLineManifold or its left form, or the
// coordinates of two points, without a manifold.
std::unique_ptr<ceres::CostFunction> MakeLineCost(const RectifiedCamera& camera,
                                                  const LineMeasurement& measurement,
                                                  CeresDerivatives derivatives,
                                                  LineParametrization line);

// Cost of a line for LineResidualKind::kProjectedEnds, by automatic derivatives. `interval`: the
// parameters of the ends along the line; not used with end points.
std::unique_ptr<ceres::CostFunction> MakeProjectedEndsCost(const RectifiedCamera& camera,
                                                           const LineMeasurement& measurement,
                                                           LineParametrization line,
                                                           const LineInterval& interval);

// Costs of one match with a fixed landmark, analytic. Parameter block: pose (7).
std::unique_ptr<ceres::CostFunction> MakePosePointCost(const RectifiedCamera& camera,
                                                       const PoseProblem::PointMatch& match);
std::unique_ptr<ceres::CostFunction> MakePoseLineCost(const RectifiedCamera& camera,
                                                      const PoseProblem::LineMatch& match);

}  // namespace plumbline

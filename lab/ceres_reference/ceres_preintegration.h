// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/inertial/preintegration.h"

#include <cstdint>
#include <span>

namespace plumbline {

// Preintegrate without covariance, its derivatives by Ceres' automatic differentiation of a second,
// plain formulation: that by the time offset includes the interpolation at both stamps. Samples
// must reach from from_ns to to_ns.
Preintegral PreintegrateByJets(std::span<const InertialSample> samples,
                               std::int64_t from_ns,
                               std::int64_t to_ns,
                               const InertialBias& bias);

}  // namespace plumbline

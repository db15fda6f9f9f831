// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace plumbline {

// Source of the derivatives of the reference's terms.
enum class CeresDerivatives {
  kAnalytic,   // those of residuals.h, in the tangent: for TangentManifold
  kAutomatic,  // of a second, plain formulation of the residuals, in the ambient numbers
};

}  // namespace plumbline

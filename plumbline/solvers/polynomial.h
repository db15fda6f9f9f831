// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

namespace plumbline {

// Returns the real roots of c[0] + c[1] x + ... + c[n] x^n, ascending, with n at most 15.
//
// Between two extrema (roots of the derivative, found recursively) a polynomial has at most one
// root, which Newton steps inside a shrinking bracket find. Roots beyond [-1, 1] are found as
// inverses of the roots of the reversed polynomial. Roots of even multiplicity may be missed if
// rounding keeps the polynomial off zero. Cost: a few microseconds for degree ten.
std::vector<double> RealRoots(std::span<const double> coefficients);

}  // namespace plumbline

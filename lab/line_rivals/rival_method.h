// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/line_rivals/rival_ba.h"
#include "plumbline/base/options.h"
#include "plumbline/matching/line_method.h"

#include <string>
#include <vector>

namespace plumbline {

// A kind of line, as lines.residual names it: observed_ends and projected_ends with the parameters
// of the product's lines; plucker_left, endpoints (with observed ends), projected_plucker_left and
// projected_endpoints with those of the laboratory.
RivalLines RivalLinesOf(const std::string& residual);
// The names that the product does not have.
std::vector<AddedMethod> AddedLineMethods();

// Returns the line method for any values of lines.residual and lines.reconstruction
// (SystemMethods::line_method). The adjustment at the end of a run has the parameters, but always
// the residual observed_ends; under projected_ends no line is constrained to be parallel to others.
// Lines that are end points keep their ends from creation on; with reconstruction=two_view they are
// made of these (LineFromTwoEnds).
LineMethod MethodFor(const LineOptions& options);

}  // namespace plumbline

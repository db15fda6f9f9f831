// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/matching/line_options.h"

namespace plumbline {

// Returns the line method for any values of lines.parametrization, lines.residual and
// lines.reconstruction: for LineOptions::method. The adjustment at the end of a run has the
// parameters, but always the residual observed_ends; under projected_ends no line is constrained to
// be parallel to others. Lines that are end points keep their ends from creation on; with
// reconstruction=two_view they are made of these (LineFromTwoEnds).
LineMethod MethodFor(const LineOptions& options);

}  // namespace plumbline

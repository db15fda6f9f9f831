// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/optimization/prepared_line.h"

namespace plumbline {

PreparedLine::PreparedLine(const OrthonormalLine& line)
    : homogeneous(line.Homogeneous()), J_orthonormal(HomogeneousJacobian(line)) {}

}  // namespace plumbline

// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/trajectory.h"

namespace plumbline::python {

// A trajectory as a Python object, which a plain vector could not be.
struct PoseList {
  Trajectory poses;
};

}  // namespace plumbline::python

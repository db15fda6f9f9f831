// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/inertial/inertial_sample.h"

#include <vector>

#include <pybind11/pybind11.h>

namespace plumbline::python {

// Returns the samples of an array (N, 7): stamp in nanoseconds, rates in rad/s, forces in m/s^2;
// none of None. Throws InputError for another shape, NaN, infinity and values that no sensor
// measures (IsPlausible), and stamps that are none.
std::vector<InertialSample> ReadInertialSamples(pybind11::handle value);

}  // namespace plumbline::python

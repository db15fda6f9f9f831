// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/calibration.h"
#include "plumbline/io/datasets/dataset.h"

namespace plumbline::python {

// Returns the sensor of a calibration.
inline SensorKind KindOf(const Calibration& calibration) {
  if (calibration.right) return SensorKind::kStereo;
  return calibration.depth_factor ? SensorKind::kRgbd : SensorKind::kMono;
}

}  // namespace plumbline::python

// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/io/datasets/dataset.h"
#include "plumbline/report/trajectory_error.h"

namespace plumbline {

// Returns the default comparison of a run's trajectory with the ground truth of its data. The scale
// is free for a single camera. Reference poses are interpolated over gaps that are usual in data of
// this format.
TrajectoryErrorOptions ErrorOptionsFor(SensorKind sensor, DatasetFormat format);

}  // namespace plumbline

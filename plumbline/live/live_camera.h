// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/camera.h"
#include "plumbline/io/image_header.h"
#include "plumbline/live/live_source.h"

#include <string>
#include <vector>

namespace plumbline {

// Returns the description of a source called `name` with data for these sensors, the richest first,
// with the camera file of the options. Throws InputError if that file is not given, if it has one
// camera but two are needed, or if the source does not offer the requested sensor.
DatasetInfo DescribeLive(const std::string& name,
                         std::vector<SensorKind> available,
                         const LiveOptions& options);

// Throws InputError unless the images have the size of the camera.
void CheckLiveSize(const std::string& name, ImageSize size, const Camera& camera);

}  // namespace plumbline

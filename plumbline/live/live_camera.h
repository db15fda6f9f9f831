// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/camera.h"
#include "plumbline/io/image_header.h"
#include "plumbline/live/live_source.h"

#include <string>
#include <vector>

namespace plumbline {

// Returns what is known about a source called `name` that offers data for these sensors, the
// richest first, with the camera file of the options. Throws InputError where that file is not
// named, where it has one camera but two are needed, or where the source does not offer the sensor
// asked for.
DatasetInfo DescribeLive(const std::string& name,
                         std::vector<SensorKind> available,
                         const LiveOptions& options);

// Throws InputError unless the images have the size of the camera.
void CheckLiveSize(const std::string& name, ImageSize size, const Camera& camera);

}  // namespace plumbline

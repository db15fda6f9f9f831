// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/camera.h"
#include "plumbline/io/image_header.h"
#include "plumbline/live/live_source.h"

#include <string>
#include <vector>

namespace plumbline {

// What is known of a source called `name` that offers data for these sensors, the richest first,
// with the camera file of the options. InputError where that is not named, is of one camera where
// two are needed, or the sensor asked for is not offered.
DatasetInfo DescribeLive(const std::string& name,
                         std::vector<SensorKind> available,
                         const LiveOptions& options);

// InputError unless the images have the size of the camera.
void CheckLiveSize(const std::string& name, ImageSize size, const Camera& camera);

}  // namespace plumbline

// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/rectified_camera.h"
#include "plumbline/map/frame.h"
#include "plumbline/map/landmarks.h"

#include <cstddef>
#include <optional>

namespace plumbline {

// The point that feature i of one stereo or RGB-D frame shows, in the world. nullopt without
// disparity, or when the depth is known to worse than max_relative_sigma (standard deviation /
// depth).
std::optional<PointModel> PointFromFrame(const RectifiedCamera& camera,
                                         const Frame& frame,
                                         std::size_t i,
                                         double max_relative_sigma);

// The line that line feature i of one stereo or RGB-D frame shows, in the world, with its
// information. nullopt without right line, when it runs along the rows (no depth), or when the
// depth of an end is known to worse than max_relative_sigma.
std::optional<LineModel> LineFromFrame(const RectifiedCamera& camera,
                                       const Frame& frame,
                                       std::size_t i,
                                       double max_relative_sigma);

}  // namespace plumbline

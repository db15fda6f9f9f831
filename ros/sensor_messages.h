// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/calibration.h"
#include "plumbline/image/image.h"
#include "plumbline/io/datasets/image_file.h"

#include "live_slam.h"
#include <optional>

namespace plumbline::ros_node {

// Value of a depth image of 16 bits per metre: millimetres (REP 118).
inline constexpr double kDepthFactor = 1000;

// The pixels in grey; colour is converted. InputError "TOPIC: expected ..., found ..." for
// encodings that show no light, sizes that do not go together, and another size than `wanted`.
GrayImage GrayOf(const RawImage& image, const ImageSize& wanted);
// Metres; 16UC1 and mono16 are millimetres, 32FC1 metres; 0, NaN, infinity: not measured.
DepthImage DepthOf(const RawImage& image, const ImageSize& wanted);

// The calibration that camera_info describes (CalibrationOf of io/recorded_calibration.h), with a
// depth image beside the left one where there is one.
Calibration CalibrationOf(const CameraNumbers& left,
                          const std::optional<CameraNumbers>& right,
                          bool rectified,
                          bool with_depth);

}  // namespace plumbline::ros_node

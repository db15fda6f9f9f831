// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/calibration.h"
#include "plumbline/image/image.h"
#include "plumbline/io/datasets/image_file.h"
#include "plumbline/io/recordings/image_message.h"

#include <optional>
#include <string>

namespace plumbline::ros_node {

// Messages with the names of their topics.
struct TopicImage {
  std::string topic;
  ImageMessage message;
};
struct TopicCamera {
  std::string topic;
  CalibrationMessage message;
};

// Value of a depth image of 16 bits per metre: millimetres (REP 118).
inline constexpr double kDepthFactor = 1000;

// The pixels in grey; colour is converted. InputError "TOPIC: expected ..., found ..." for
// encodings that show no light, sizes that do not go together, files that cannot be decoded, and
// another size than `wanted`.
GrayImage GrayOf(const TopicImage& image, const ImageSize& wanted);
// Metres; 16UC1 and mono16 are millimetres, 32FC1 metres; 0, NaN, infinity: not measured.
DepthImage DepthOf(const TopicImage& image, const ImageSize& wanted);

// The calibration that camera_info describes (CalibrationOf of io/recorded_calibration.h), with a
// depth image beside the left one where there is one.
Calibration CalibrationOf(const TopicCamera& left,
                          const std::optional<TopicCamera>& right,
                          bool rectified,
                          bool with_depth);

}  // namespace plumbline::ros_node

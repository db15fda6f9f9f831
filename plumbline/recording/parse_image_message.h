// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/recording/image_message.h"
#include "plumbline/recording/recording.h"

#include <cstdint>
#include <optional>
#include <span>

namespace plumbline {

// Returns the form of a channel's messages: sensor_msgs/Image, CompressedImage and CameraInfo of
// ROS 1 and (with /msg/, as CDR) ROS 2, foxglove.RawImage, CompressedImage and CameraCalibration as
// protobuf; nullopt for all others.
std::optional<MessageForm> FormOf(const Channel& channel);

// Return nullopt if the bytes are no message of this form. `form` must be that of an image, or of a
// calibration.
std::optional<ImageMessage> ParseImage(MessageForm form, std::span<const std::uint8_t> bytes);
std::optional<CalibrationMessage> ParseCalibration(MessageForm form,
                                                   std::span<const std::uint8_t> bytes);

}  // namespace plumbline

// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/recording/image_message.h"

#include <cstdint>
#include <optional>
#include <span>

namespace plumbline {

// Parse messages of Foxglove's schemas (foxglove.RawImage, CompressedImage, CameraCalibration) in
// the wire format of Protocol Buffers (protobuf.dev/programming-guides/encoding). Unknown fields
// are skipped; missing ones have their default. Return nullopt if the bytes are malformed.
std::optional<ImageMessage> ParseProtobufImage(bool compressed,
                                               std::span<const std::uint8_t> bytes);
std::optional<CalibrationMessage> ParseProtobufCalibration(std::span<const std::uint8_t> bytes);

}  // namespace plumbline

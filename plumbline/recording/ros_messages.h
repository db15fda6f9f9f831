// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/recording/image_message.h"

#include <cstdint>
#include <optional>
#include <span>

namespace plumbline {

// Messages of ROS, field after field: of ROS 1 without gaps (wiki.ros.org/msg), of ROS 2 as
// little-endian CDR (OMG, DDS-XTypes 1.3, 7.4.3: numbers at multiples of their size, texts with a
// zero at their end, behind four bytes that say so). nullopt where the bytes end early or, of
// ROS 2, say that they are encoded in another way.
std::optional<ImageMessage> ParseRosImage(bool cdr,
                                          bool compressed,
                                          std::span<const std::uint8_t> bytes);
std::optional<CalibrationMessage> ParseRosCalibration(bool cdr,
                                                      std::span<const std::uint8_t> bytes);

}  // namespace plumbline

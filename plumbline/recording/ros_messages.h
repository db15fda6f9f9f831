// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/recording/image_message.h"

#include <cstdint>
#include <optional>
#include <span>

namespace plumbline {

// Parse messages of ROS, field after field. Those of ROS 1 have no gaps (wiki.ros.org/msg). Those
// of ROS 2 are little-endian CDR (OMG, DDS-XTypes 1.3, 7.4.3): numbers at multiples of their size,
// texts with a zero at their end, all after four bytes that name the encoding. Return nullopt if
// the bytes end early, or if these four bytes name another encoding.
std::optional<ImageMessage> ParseRosImage(bool cdr,
                                          bool compressed,
                                          std::span<const std::uint8_t> bytes);
std::optional<CalibrationMessage> ParseRosCalibration(bool cdr,
                                                      std::span<const std::uint8_t> bytes);

}  // namespace plumbline

// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <numbers>

namespace plumbline {

inline constexpr double kDegree = std::numbers::pi / 180;  // radians
inline constexpr std::int64_t kNsPerSecond = 1'000'000'000;

}  // namespace plumbline

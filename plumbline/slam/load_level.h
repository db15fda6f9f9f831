// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <type_traits>
#include <utility>

namespace plumbline {

// Work that a live run leaves out for a frame if the machine is too slow or too busy. Each value
// includes those before it.
enum class LoadLevel {
  kNothing,
  kMapping,  // mapping makes fewer landmarks and adjusts a smaller window
  kLines,    // fewer lines are measured
  kPoints,   // fewer points are measured
  kFrame     // the frame is left out
};
constexpr auto EnumNames(std::type_identity<LoadLevel>) {
  return std::array{std::pair{LoadLevel::kNothing, ""},
                    std::pair{LoadLevel::kMapping, "mapping"},
                    std::pair{LoadLevel::kLines, "lines"},
                    std::pair{LoadLevel::kPoints, "points"},
                    std::pair{LoadLevel::kFrame, "frame"}};
}

}  // namespace plumbline

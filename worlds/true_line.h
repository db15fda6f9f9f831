// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/segment.h"

#include <array>
#include <cstdint>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

namespace plumbline {

// Visible cause of a straight line of a known world.
enum class TrueLineKind {
  kGeometry,  // edge of a body
  kTexture,   // painted on a surface
  kShadow,    // border of a shadow
};
constexpr auto EnumNames(std::type_identity<TrueLineKind>) {
  return std::array{std::pair{TrueLineKind::kGeometry, "geometry"},
                    std::pair{TrueLineKind::kTexture, "texture"},
                    std::pair{TrueLineKind::kShadow, "shadow"}};
}
inline constexpr std::size_t kTrueLineKinds = EnumNames(std::type_identity<TrueLineKind>{}).size();

// The frames `first` to `last` of a sequence, both included, counted from 0.
struct FrameRange {
  int first = 0, last = 0;

  bool operator==(const FrameRange&) const = default;
};

// A straight line of a known world, as in a perfect line map.
struct TrueLine {
  Segment3 segment;  // metres, world of the ground truth
  TrueLineKind kind = TrueLineKind::kGeometry;
  // The frames that see any part of it, ascending and disjoint; nullopt if not recorded.
  std::optional<std::vector<FrameRange>> visible = std::nullopt;

  // Number of frames that see it; nullopt if not recorded.
  std::optional<std::int64_t> VisibleFrames() const {
    if (!visible) return std::nullopt;
    std::int64_t count = 0;
    for (const FrameRange& range : *visible) {
      count += std::int64_t{range.last} - std::int64_t{range.first} + 1;
    }
    return count;
  }
};

}  // namespace plumbline

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

// What makes a straight line of a known world visible.
enum class TrueLineKind {
  kGeometry,  // it is an edge of a body
  kTexture,   // it is painted on a surface
  kShadow,    // it is the border of a shadow
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

// A straight line of a known world, as a perfect line map would have it.
struct TrueLine {
  Segment3 segment;  // metres, world of the ground truth
  TrueLineKind kind = TrueLineKind::kGeometry;
  // The frames in which any of it is seen, ascending and disjoint; nullopt where nobody recorded
  // them.
  std::optional<std::vector<FrameRange>> visible = std::nullopt;

  // Number of frames that see it; nullopt where nobody recorded them.
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

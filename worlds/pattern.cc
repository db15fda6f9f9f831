// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "worlds/pattern.h"

#include "plumbline/base/error.h"
#include "worlds/noise.h"

#include <algorithm>
#include <cmath>

namespace plumbline {

void Pattern::AppendEdges(const Eigen::AlignedBox2d& /*window*/,
                          std::vector<Segment2>* /*edges*/) const {}

std::unique_ptr<const Pattern> MakePattern(Material material, const PatternFrame& frame) {
  PatternFrame mixed = frame;
  mixed.seed = MixBits(frame.seed);
  for (const auto make : {MakeGrownPattern, MakeLaidPattern, MakePrintedPattern}) {
    if (auto pattern = make(material, mixed)) return pattern;
  }
  throw BugError("a material without a pattern");
}

double Covered(double x, double low, double high, double cell) {
  if (cell <= 0) return x >= low && x <= high ? 1.0 : 0.0;
  const double from = std::max(low, x - 0.5 * cell), to = std::min(high, x + 0.5 * cell);
  return std::clamp((to - from) / cell, 0.0, 1.0);
}

std::optional<Segment2> ClipToBox(const Segment2& segment, const Eigen::AlignedBox2d& box) {
  const Eigen::Vector2d way = segment.end - segment.start;
  double from = 0, to = 1;
  for (int k = 0; k < 2; ++k) {
    const double low = box.min()(k) - segment.start(k), high = box.max()(k) - segment.start(k);
    if (way(k) == 0) {
      if (low > 0 || high < 0) return std::nullopt;
      continue;
    }
    from = std::max(from, std::min(low / way(k), high / way(k)));
    to = std::min(to, std::max(low / way(k), high / way(k)));
  }
  if (from >= to) return std::nullopt;
  return Segment2{segment.start + from * way, segment.start + to * way};
}

}  // namespace plumbline

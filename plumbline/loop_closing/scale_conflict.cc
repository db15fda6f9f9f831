// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/loop_closing/scale_conflict.h"

#include "plumbline/base/elementary.h"
#include "plumbline/loop_closing/verify_loop.h"

#include <cmath>
#include <numbers>

namespace plumbline {

std::optional<ScaleConflict> FindScaleConflict(const Map& map,
                                               KeyFrameId newest,
                                               std::span<const KeyFrameId> candidates,
                                               const CameraAndPyramid& imaging,
                                               const LoopOptions& options) {
  constexpr double kDeviations = 5;
  for (const KeyFrameId candidate : candidates) {
    const auto edge = VerifyLoop(map, newest, map, candidate, imaging, options.verification);
    if (!edge) continue;
    const Similarity3 older_from_newest =
        CandidateFromQueryToday(*edge, map.PlaceOf(newest).scale, map.PlaceOf(candidate).scale);
    const auto steps = static_cast<double>(map.NumberOf(newest) - map.NumberOf(candidate));
    const double drift = options.drift.log_scale * std::sqrt(steps);
    const double sigma = math::Hypot(drift, std::sqrt(edge->covariance(6, 6)));
    const double log_scale = std::abs(math::Log(older_from_newest.scale));
    if (log_scale > std::numbers::ln2 && log_scale > kDeviations * sigma) {
      return ScaleConflict{candidate, older_from_newest.scale};
    }
  }
  return std::nullopt;
}

}  // namespace plumbline

// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/features/match_lines.h"
#include "plumbline/features/match_points.h"
#include "plumbline/image/byte_format.h"
#include "plumbline/initialization/initializer.h"
#include "plumbline/initialization/matching.h"
#include "plumbline/map/state_format.h"

#include <cstddef>
#include <vector>

namespace plumbline {

// Transfer (base/byte_format.h) of what starts of monocular maps keep. The rest is visited by the
// classes themselves (VisitState).

template <class Archive, Like<PointMatch> T>
void Transfer(Archive& archive, T& match) {
  TransferAll(archive, match.a, match.b, match.distance);
}
template <class Archive, Like<LineMatch> T>
void Transfer(Archive& archive, T& match) {
  TransferAll(archive, match.a, match.b, match.distance);
}
template <class Archive, Like<ReferenceMatches> T>
void Transfer(Archive& archive, T& matches) {
  TransferAll(archive, matches.points, matches.lines, matches.motion);
}

template <class Archive, Like<InitializationFrame> T>
void Transfer(Archive& archive, T& frame) {
  TransferAll(archive, frame.id, frame.stamp_ns, frame.indexed, frame.image);
  if constexpr (Archive::kReading) {
    const RectifiedCamera& camera = archive.camera();
    const bool of_camera = frame.image == nullptr || (frame.image->width() == camera.width &&
                                                      frame.image->height() == camera.height);
    if (frame.indexed == nullptr || !of_camera) {
      FailState(archive, "a frame without features or of another size");
    }
  }
}

// Whether all matches are between features that exist.
template <class Match>
bool AreWithin(const std::vector<Match>& matches, std::size_t size_a, std::size_t size_b) {
  for (const Match& match : matches) {
    if (match.a < 0 || match.b < 0 || static_cast<std::size_t>(match.a) >= size_a ||
        static_cast<std::size_t>(match.b) >= size_b) {
      return false;
    }
  }
  return true;
}

}  // namespace plumbline

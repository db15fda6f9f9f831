// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/state_format.h"
#include "plumbline/tracking/relocalization.h"
#include "plumbline/tracking/tracker.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace plumbline {

// Transfer (base/byte_format.h) of the state that the tracker keeps from frame to frame.

template <class Archive, Like<CandidatePoint> T>
void Transfer(Archive& archive, T& point) {
  TransferAll(archive, point.id, point.model, point.covariance);
}
template <class Archive, Like<CandidateLine> T>
void Transfer(Archive& archive, T& line) {
  TransferAll(archive, line.id, line.model);
}
template <class Archive, Like<FrameMatches> T>
void Transfer(Archive& archive, T& matches) {
  TransferAll(archive, matches.point_of_feature, matches.line_of_feature);
}

// Whether each match is -1 (none) or an index into a list of so many candidates.
inline bool AreIndices(const std::vector<int>& matches, std::size_t candidates) {
  return std::all_of(matches.begin(), matches.end(), [&](int index) {
    return index >= -1 && (index < 0 || static_cast<std::size_t>(index) < candidates);
  });
}

template <class Archive, Like<FrameAssociation> T>
void Transfer(Archive& archive, T& association) {
  TransferAll(archive, association.points, association.lines, association.matches);
  if constexpr (Archive::kReading) {
    if (!AreIndices(association.matches.point_of_feature, association.points.size()) ||
        !AreIndices(association.matches.line_of_feature, association.lines.size())) {
      FailState(archive, "matches with no landmark");
    }
  }
}

template <class Archive, Like<FrameCounts> T>
void Transfer(Archive& archive, T& c) {
  TransferAll(archive, c.matched_points, c.matched_lines, c.inlier_points, c.inlier_lines);
}
template <class Archive, Like<MapUse> T>
void Transfer(Archive& archive, T& use) {
  TransferAll(archive, use.next_keyframe, use.read_only, use.patience);
}

template <class Archive, Like<Relocalized> T>
void Transfer(Archive& archive, T& found) {
  TransferAll(archive, found.frame, found.association, found.keyframe, found.counts);
  Transfer(archive, found.scene_depth);
  if constexpr (Archive::kReading) {
    if (!LastFrame{found.frame, found.association}.IsConsistent()) {
      FailState(archive, "matches of other features");
    }
  }
}

}  // namespace plumbline

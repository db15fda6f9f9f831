// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/rectified_camera.h"
#include "plumbline/map/map.h"
#include "plumbline/map/snapshot.h"
#include "plumbline/mapping/options.h"
#include "plumbline/tracking/tracker.h"

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

namespace plumbline {

// Keyframes that a live run has made and mapping has not reached yet. The camera is tracked against
// them all the same, by landmarks made from their depths. These landmarks have provisional ids
// until the map has landmarks in their place.

// The landmark that a provisional id names, by a keyframe and the number of its feature.
// Provisional ids are greater than any id that a map gives, so that the two are never confused.
struct ProvisionalLandmark {
  KeyFrameId keyframe;
  std::size_t feature = 0;
};
template <class LandmarkId>
LandmarkId ProvisionalId(const ProvisionalLandmark& landmark);
// Returns nullopt for an id that a map gave and for an invalid one.
template <class LandmarkId>
std::optional<ProvisionalLandmark> FindProvisional(LandmarkId id);

// Returns the snapshot with the keyframes ahead of it added, in the order in which they were made.
// Each keyframe stands beside its parent, counts as one more observation of the landmarks that it
// shows, and adds the landmarks that its depths give. The newest keyframe becomes the snapshot's
// centre. Cost: a copy of the snapshot and some 0.1 ms a keyframe.
std::shared_ptr<const MapSnapshot> WithPendingKeyFrames(
    const MapSnapshot& snapshot,
    const std::vector<std::shared_ptr<const NewKeyFrame>>& ahead,
    const RectifiedCamera& camera,
    const LandmarkCreationOptions& options);

// Returns a keyframe as the map takes it in. Its pose follows from that of its parent, which is or
// was in the map, as the parent stands now. Provisional landmarks are replaced by those that the
// map has in their place; where it has none, the feature shows no landmark.
KeyFrame SettledIn(const Map& map, const NewKeyFrame& added);

// Returns how much a map would lose without the keyframe: the number of its features that match no
// landmark. Where the camera measures depth, only features with depth count.
int NewMeasurements(const NewKeyFrame& added, const RectifiedCamera& camera);

// Takes the keyframe at `place`, not the last one, out of the waiting keyframes, which are in the
// order in which they were made, and returns it. Keyframes tracked against it refer to its parent
// from then on, the next keyframe that shows one of its landmarks makes that landmark anew, and the
// next keyframe gets its scores.
std::shared_ptr<const NewKeyFrame> TakeOut(
    std::size_t place, std::vector<std::shared_ptr<const NewKeyFrame>>& waiting);

}  // namespace plumbline

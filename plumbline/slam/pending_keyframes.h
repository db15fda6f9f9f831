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

// Keyframes of a live run that mapping has not inserted yet. Tracking uses them nevertheless, by
// landmarks made from their depths. These landmarks have provisional ids until the map has its own
// landmarks for the same features.

// The landmark of a provisional id, by a keyframe and the index of its feature. Provisional ids are
// greater than any id of a map, so that the two are never confused.
struct ProvisionalLandmark {
  KeyFrameId keyframe;
  std::size_t feature = 0;
};
template <class LandmarkId>
LandmarkId ProvisionalId(const ProvisionalLandmark& landmark);
// Returns nullopt for an id of a map and for an invalid one.
template <class LandmarkId>
std::optional<ProvisionalLandmark> FindProvisional(LandmarkId id);

// Returns the snapshot with the pending keyframes added, in the order of their creation. Each
// keyframe is placed relative to its parent, counts as one more observation of its landmarks, and
// adds the landmarks of its depths. The newest keyframe becomes the snapshot's centre. Cost: a copy
// of the snapshot and some 0.1 ms a keyframe.
std::shared_ptr<const MapSnapshot> WithPendingKeyFrames(
    const MapSnapshot& snapshot,
    const std::vector<std::shared_ptr<const NewKeyFrame>>& ahead,
    const RectifiedCamera& camera,
    const LandmarkCreationOptions& options);

// Returns a keyframe as inserted into the map. Its pose follows from the current pose of its
// parent, which is or was in the map. Provisional landmarks are replaced by the map's own for the
// same features; a feature without one gets no landmark.
KeyFrame SettledIn(const Map& map, const NewKeyFrame& added);

// Returns the value of a keyframe to a map: the number of its features without a landmark. If the
// camera measures depth, only features with depth count.
int NewMeasurements(const NewKeyFrame& added, const RectifiedCamera& camera);

// Removes the keyframe at `place`, not the last one, from the waiting keyframes, which are in the
// order of their creation, and returns it. Keyframes tracked against it refer to its parent from
// then on, the next keyframe that shows one of its landmarks makes that landmark anew, and the next
// keyframe gets its scores.
std::shared_ptr<const NewKeyFrame> TakeOut(
    std::size_t place, std::vector<std::shared_ptr<const NewKeyFrame>>& waiting);

}  // namespace plumbline

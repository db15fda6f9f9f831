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
// them all the same: against the landmarks that their depths give, which have provisional ids until
// the map has landmarks in their place.

// What a provisional id names: a landmark by a feature of a keyframe. Provisional ids are greater
// than any that a map gives, so that a map has none of them.
struct ProvisionalLandmark {
  KeyFrameId keyframe;
  std::size_t feature = 0;
};
template <class LandmarkId>
LandmarkId ProvisionalId(const ProvisionalLandmark& landmark);
// nullopt for an id of the map and an invalid one.
template <class LandmarkId>
std::optional<ProvisionalLandmark> FindProvisional(LandmarkId id);

// The snapshot and the keyframes ahead of it, in the order in which they were made: each where its
// parent says, with the landmarks that it shows counted once more and those that its depths give
// added. The newest one is the centre. Cost: a copy of the snapshot and some 0.1 ms a keyframe.
std::shared_ptr<const MapSnapshot> WithKeyFramesAhead(
    const MapSnapshot& snapshot,
    const std::vector<std::shared_ptr<const NewKeyFrame>>& ahead,
    const RectifiedCamera& camera,
    const LandmarkCreationOptions& options);

// A keyframe as the map takes it in: where its parent, which is or was in the map, says today, and
// with the landmarks that the map has in place of provisional ones; none where it has none.
KeyFrame SettledIn(const Map& map, const NewKeyFrame& added);

// How much a map would lose without the keyframe: its features that no other keyframe's landmark
// explains, those with depth only where the camera measures depth.
int NewMeasurements(const NewKeyFrame& added, const RectifiedCamera& camera);

// Takes the keyframe at `place`, not the last, out of keyframes that wait in the order in which
// they were made. Those tracked against it hang on its parent from then on, its landmarks become
// those of the next that shows them, and the next one gets its scores. Returns it.
std::shared_ptr<const NewKeyFrame> TakeOut(
    std::size_t place, std::vector<std::shared_ptr<const NewKeyFrame>>& waiting);

}  // namespace plumbline

// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/association/projection_search.h"
#include "plumbline/map/map.h"
#include "plumbline/map/young_landmarks.h"
#include "plumbline/mapping/options.h"

namespace plumbline {

// Removes young landmarks that the tracker seldom finds where they should be, or that too few
// keyframes show after their trial; those that passed the trial leave the list.
MapEdit RemoveWeakLandmarks(const Map& map, KeyFrameId newest, YoungLandmarks& young);

// Removes one keyframe, or none: the first of those around `centre`, closest in covisibility,
// nearly all of whose landmarks (of those that any other shows) three others show, points at most
// an octave coarser. The first keyframe, `centre` and the newest before it stay.
MapEdit RemoveRedundantKeyFrames(const Map& map, KeyFrameId centre, const CleanupOptions& options);

// Removes keyframes where a place is seen again: less of a keyframe's landmarks need be shown by
// others (CleanupOptions::revisited_share), but of each by one that is of another visit, more than
// 20 keyframes before or after. The camera comes again and again and makes keyframes each time, and
// a landmark is found again in some of them only: by the first rule alone there would be ever more.
// What too few keyframes show after that goes, too. Looks at the 30 closest keyframes.
MapEdit RemoveRevisitedKeyFrames(const Map& map, KeyFrameId centre, const CleanupOptions& options);

}  // namespace plumbline

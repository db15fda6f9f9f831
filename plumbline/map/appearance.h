// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/frame.h"
#include "plumbline/map/id_table.h"
#include "plumbline/map/landmarks.h"

namespace plumbline {

// Recomputes the appearance of a landmark from its observations. The descriptor is the one with the
// least median Hamming distance to the others (ties: the oldest keyframe's); the viewing direction
// is the mean. Points also get distance and octave of the newest observation, from which the octave
// at any other distance follows. Only the newest 12 observations count. Cost: O(n^2) in their
// number.
void RefreshAppearance(const IdTable<KeyFrameId, KeyFrame>& keyframes, MapPoint& point);
void RefreshAppearance(const IdTable<KeyFrameId, KeyFrame>& keyframes, MapLine& line);

}  // namespace plumbline

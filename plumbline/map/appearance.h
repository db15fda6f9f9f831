// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/frame.h"
#include "plumbline/map/id_table.h"
#include "plumbline/map/landmarks.h"

namespace plumbline {

// Recomputes what a landmark looks like from its observations: the descriptor with the least median
// Hamming distance to the others (ties: the oldest keyframe's), the mean viewing direction, and for
// points the distance and octave of the newest observation, from which the octave at any other
// distance follows. Cost O(n^2) in the number of observations, at most the newest 12 of which
// count.
void RefreshAppearance(const IdTable<KeyFrameId, KeyFrame>& keyframes, MapPoint& point);
void RefreshAppearance(const IdTable<KeyFrameId, KeyFrame>& keyframes, MapLine& line);

}  // namespace plumbline

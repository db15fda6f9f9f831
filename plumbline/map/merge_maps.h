// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/sim3.h"
#include "plumbline/map/map.h"

namespace plumbline {

// Both maps as one, in the world and the unit of the first, made with the same camera. Keyframes,
// points and lines of the second get new ids behind those of the first; its first keyframe stays
// without a parent. Nothing is fused: what both maps show is there twice. Disparities of the second
// get the stereo correction of the first. The second's record of removed and merged objects is not
// taken over.
//
//   first_from_second  of the worlds; its scale must be 1 where depth is measured (the measured
//                      disparities would contradict the map otherwise)
//   cost               O(observations)
Map MergeMaps(const Map& first, const Map& second, const Similarity3& first_from_second);

}  // namespace plumbline

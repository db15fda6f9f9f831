// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/sim3.h"
#include "plumbline/map/frame.h"
#include "plumbline/map/landmarks.h"

namespace plumbline {

// Functions that move parts of a map: X_new = new_from_old * X. A camera that moves by the same
// similarity as its landmarks keeps its view: directions and image positions stay, depths are
// multiplied by the scale.

// Moves a keyframe, whose view of all landmarks that move with it is unchanged.
void Move(const Similarity3& new_from_old, KeyFrame& keyframe);

// Moves position, viewing direction and reference distance.
void Move(const Similarity3& new_from_old, PointModel& point);

// Moves the line, its interval, viewing direction and information, which becomes that of the
// orthonormal tangent of the moved line. To first order the two tangents are related by the
// derivative of (moment, direction), eq. 19, and by the similarity, which is linear in these.
void Move(const Similarity3& new_from_old, LineModel& line);

// Returns the line in a world moved by a similarity: eq. 9 with moments multiplied by the scale.
PluckerLine Transform(const Similarity3& new_from_old, const PluckerLine& line);

}  // namespace plumbline

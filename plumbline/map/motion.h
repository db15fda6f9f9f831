// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/sim3.h"
#include "plumbline/map/frame.h"
#include "plumbline/map/landmarks.h"

namespace plumbline {

// Moves single parts of a map from one place of its world to another: X_new = new_from_old * X.
// What moves by the same similarity stays as it is for a camera among it: directions and image
// positions do not change, depths are multiplied by the scale.

// The camera keeps its view of all that moves with it.
void Move(const Similarity3& new_from_old, KeyFrame& keyframe);

// Position, viewing direction and reference distance.
void Move(const Similarity3& new_from_old, PointModel& point);

// The line, its interval, viewing direction, and the information: that of the orthonormal tangent
// of the moved line. The tangents are tied to first order by the derivative of (moment, direction),
// eq. 19, and the similarity, which is linear in them.
void Move(const Similarity3& new_from_old, LineModel& line);

// The line in a world moved by a similarity: eq. 9 with moments multiplied by the scale.
PluckerLine Transform(const Similarity3& new_from_old, const PluckerLine& line);

}  // namespace plumbline

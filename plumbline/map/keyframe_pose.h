// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/se3.h"

#include <cmath>

namespace plumbline {

// Whether what was read from a file can be a pose: finite, with a rotation of norm 1.
inline bool IsPose(const Rigid3& pose) {
  return pose.translation.allFinite() && std::abs(pose.rotation.norm() - 1) < 1e-6;
}

// The pose of a keyframe, and the present scale of lengths around it (KeyFrame::scale).
struct KeyFramePose {
  Rigid3 cam_from_world;
  double scale = 1;
};

// A pose relative to a keyframe, measured when the keyframe's scale was `scale`. Frames, removed
// keyframes and the tracker keep such poses, which move with the keyframe and change their lengths
// with its scale.
struct RelativePose {
  Rigid3 cam_from_keyframe;
  double scale = 1;
};

// Returns the relative pose in the keyframe's present scale.
inline Rigid3 Rescaled(const RelativePose& relative, double scale) {
  return {relative.cam_from_keyframe.rotation,
          (scale / relative.scale) * relative.cam_from_keyframe.translation};
}

// Returns cam_from_world of the relative pose, for the present place of the keyframe.
inline Rigid3 ComposePose(const KeyFramePose& keyframe, const RelativePose& relative) {
  return Rescaled(relative, keyframe.scale) * keyframe.cam_from_world;
}

// Turns a pose relative to a keyframe into a pose relative to the keyframe's parent.
inline RelativePose Chained(const RelativePose& relative, const RelativePose& keyframe) {
  return {Rescaled(relative, keyframe.scale) * keyframe.cam_from_keyframe, keyframe.scale};
}

}  // namespace plumbline

// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/se3.h"

#include <cmath>

namespace plumbline {

// Returns true if a pose read from a file is valid: finite, with a rotation of norm 1.
inline bool IsPose(const Rigid3& pose) {
  return pose.translation.allFinite() && std::abs(pose.rotation.norm() - 1) < 1e-6;
}

// The pose of a keyframe, and its scale (KeyFrame::scale).
struct KeyFramePose {
  Rigid3 cam_from_world;
  double scale = 1;
};

// A pose relative to a keyframe, measured when the keyframe's scale was `scale`. Frames, removed
// keyframes and the tracker keep relative poses, which follow the keyframe's motion and scale.
struct RelativePose {
  Rigid3 cam_from_keyframe;
  double scale = 1;
};

// Returns the relative pose in the keyframe's current scale.
inline Rigid3 Rescaled(const RelativePose& relative, double scale) {
  return {relative.cam_from_keyframe.rotation,
          (scale / relative.scale) * relative.cam_from_keyframe.translation};
}

// Returns cam_from_world of the relative pose, for the current pose of the keyframe.
inline Rigid3 ComposePose(const KeyFramePose& keyframe, const RelativePose& relative) {
  return Rescaled(relative, keyframe.scale) * keyframe.cam_from_world;
}

// Converts a pose relative to a keyframe into a pose relative to the keyframe's parent.
inline RelativePose Chained(const RelativePose& relative, const RelativePose& keyframe) {
  return {Rescaled(relative, keyframe.scale) * keyframe.cam_from_keyframe, keyframe.scale};
}

}  // namespace plumbline

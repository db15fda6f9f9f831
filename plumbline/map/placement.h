// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/se3.h"

namespace plumbline {

// Where a keyframe is and how long lengths around it have become: KeyFrame::unit.
struct Placement {
  Rigid3 cam_from_world;
  double unit = 1;
};

// A pose relative to a keyframe, written down when the keyframe's unit was `unit`. Frames, removed
// keyframes and the tracker keep such poses: they move with the keyframe, and their lengths change
// with its unit.
struct RelativePose {
  Rigid3 cam_from_keyframe;
  double unit = 1;
};

// The relative pose in the keyframe's unit of today.
inline Rigid3 InUnit(const RelativePose& relative, double unit) {
  return {relative.cam_from_keyframe.rotation,
          (unit / relative.unit) * relative.cam_from_keyframe.translation};
}

// cam_from_world of what the relative pose stands for, where the keyframe is today.
inline Rigid3 PoseBeside(const Placement& keyframe, const RelativePose& relative) {
  return InUnit(relative, keyframe.unit) * keyframe.cam_from_world;
}

// A pose relative to a keyframe as a pose relative to the keyframe's parent.
inline RelativePose Chained(const RelativePose& relative, const RelativePose& keyframe) {
  return {InUnit(relative, keyframe.unit) * keyframe.cam_from_keyframe, keyframe.unit};
}

}  // namespace plumbline

// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/features/types.h"
#include "plumbline/geometry/rectified_camera.h"
#include "plumbline/image/image.h"
#include "plumbline/image/pyramid.h"
#include "plumbline/map/edit.h"
#include "plumbline/map/map.h"

#include <cstddef>
#include <deque>
#include <memory>
#include <optional>

#include <Eigen/Core>

namespace plumbline {

// The patches that recent keyframes show around their corners.
struct KeyFramePatches {
  static constexpr int kRadius = 3;  // radius of a patch
  static constexpr int kWideSide = 2 * (kRadius + 1) + 1;
  static constexpr int kSamples = kWideSide * kWideSide;

  KeyFrameId keyframe;
  // One row for each point feature: the samples of its patch in steps of its octave, with one more
  // on each side for derivatives. Samples are zero where the patch leaves the image.
  GrayImage samples;
};

// Finds where a new keyframe shows exactly those points of the scene that older keyframes show.
//
// The corners that a detector finds in two images are not quite the same point of the scene. They
// lie inside of their edges by a part of a pixel of their octave, so that a point that comes nearer
// moves with each octave in which it is found. Along a road all points do so, and the scale of a
// map of one camera falls (docs/log/single-camera.md).
//
// The reference is therefore the patch around the corner in the oldest of the recent keyframes that
// show the landmark. It is warped by the depth and the poses as if it faced that camera, and
// shifted until it fits the new image (AlignShift). The feature is moved to the mean of its corner
// and that place, weighed by their covariances. The moved feature is a reference for later
// keyframes in turn, so that all observations of a landmark speak of the point that the first of
// them shows.
class PointAligner {
 public:
  static constexpr std::size_t kRecent = 20;  // number of keyframes whose patches are kept

  // octave_scale: how many times smaller each octave of the image pyramid is than the one below.
  PointAligner(const RectifiedCamera& camera, double octave_scale)
      : camera_(camera), octave_scale_(octave_scale) {}

  // Returns the features of a keyframe of the map, with those points moved to where they align that
  // have patches in recent keyframes; nullptr where there is none. Remembers the patches of this
  // keyframe. `pyramid` is that of its rectified left image with the given scale of octaves
  // (BuildOrbPyramid). Deviations stay as they are. Cost: about 5 microseconds a point that is
  // looked for, and the patches of all corners.
  std::shared_ptr<const FrameFeatures> Align(const Map& map,
                                             KeyFrameId id,
                                             const ImagePyramid& pyramid);

  // The patches of recent keyframes, the oldest keyframe first.
  const std::deque<KeyFramePatches>& recent() const { return recent_; }

 private:
  struct Reference {
    const Frame* frame = nullptr;
    std::size_t feature = 0;
    const KeyFramePatches* patches = nullptr;
  };
  std::optional<Reference> OldestReference(const Map& map, const MapPoint& point) const;
  std::optional<Eigen::Vector2d> Find(const Reference& reference,
                                      const Eigen::Vector3d& position,
                                      const Frame& frame,
                                      const Eigen::Vector2d& px,
                                      const ImagePyramid& pyramid) const;
  void Remember(KeyFrameId id, const Features& features, const ImagePyramid& pyramid);

  RectifiedCamera camera_;
  double octave_scale_;
  std::deque<KeyFramePatches> recent_;
};

}  // namespace plumbline

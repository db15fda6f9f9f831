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

// Image patches around the corners of a recent keyframe.
struct KeyFramePatches {
  static constexpr int kRadius = 3;  // radius of a patch
  static constexpr int kWideSide = 2 * (kRadius + 1) + 1;
  static constexpr int kSamples = kWideSide * kWideSide;

  KeyFrameId keyframe;
  // One row for each point feature: the samples of its patch in steps of its octave, with one more
  // on each side for derivatives. Zero if the patch leaves the image.
  GrayImage samples;
};

// Aligns the points of a new keyframe with the same points of the scene in older keyframes.
//
// A detector's corners in two images are not exactly the same point of the scene. They lie inside
// of their edges by a fraction of a pixel of their octave, so that an approaching point moves with
// each octave of its detection. Along a road all points do so, and the scale of a map of one camera
// shrinks (lab/notes/single-camera.md).
//
// The reference is therefore the patch around the corner in the oldest of the recent keyframes that
// show the landmark. It is warped by the depth and the poses as if it faced that camera, and
// shifted until it fits the new image (AlignShift). The feature is moved to the mean of its corner
// and the aligned position, weighted by their covariances. The moved feature is a reference for
// later keyframes in turn, so that all observations of a landmark refer to the point of the first
// one.
class PointAligner {
 public:
  static constexpr std::size_t kRecent = 20;  // number of keyframes whose patches are kept

  // octave_scale: reduction factor from each octave of the image pyramid to the next.
  PointAligner(const RectifiedCamera& camera, double octave_scale)
      : camera_(camera), octave_scale_(octave_scale) {}

  // Returns the features of a keyframe of the map, with points aligned that have patches in recent
  // keyframes; nullptr if there are none. Stores the patches of this keyframe. `pyramid` is that of
  // its rectified left image with the given scale of octaves (BuildOrbPyramid). Deviations are
  // unchanged. Cost: about 5 microseconds a searched point, and the patches of all corners.
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

// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/features/feature_correction.h"
#include "plumbline/geometry/rectified_camera.h"
#include "plumbline/map/atlas.h"
#include "plumbline/map/edit.h"
#include "plumbline/map/map.h"

#include <cstddef>
#include <deque>
#include <memory>
#include <optional>

namespace plumbline {

// Estimates the smooth part of the errors of disparities (StereoCorrection) from a map.
//
// If at least three keyframes show a point in their left images, these and the poses predict its
// position in the right image to a standard deviation of 2.5e-4 of the image's width or better. The
// measured position differs by c(x, y) + s d: the displacement c, and the disparity d times the
// error s of the map's scale around that keyframe. s is unknown for each keyframe and eliminated
// (Schur complement). Interpreted as a displacement, it would reinforce the error of the
// disparities, since near things are below and far ones above. Only points are used: without
// points, lines gave a correction that bent the map.
//
// Each coefficient has a normal prior with a standard deviation of 4e-4 of the image's width.
// Evidence enters under the Huber loss. The mean of c over all evidence is kept, since it
// determines the scale of the map, which must come from the calibration. The rest of c has five
// independent parts (common eigenvectors of its covariance and of its mean square). Each is shrunk
// by 1 - variance / square, to zero if that is negative (James and Stein 1961, positive part), so
// that little evidence changes little. Corners at depth edges have biased disparities, some
// hundredths of a pixel in the mean. The whole of c is therefore shrunk by 1 - (0.04 px / rms of
// c)^2, so that a good calibration is unchanged.
class StereoCalibrator {
 public:
  explicit StereoCalibrator(const RectifiedCamera& camera);

  // Adds the disparities of one keyframe. Call once for each keyframe, when later ones show the
  // same landmarks. Does nothing with a single camera. Cost: a triangulation for each landmark.
  void Observe(const Map& map, const KeyFrame& keyframe);

  // Returns the correction estimated from all evidence so far; no correction without evidence.
  StereoCorrection Estimate() const;

  // All evidence so far. It can be passed to the calibrator of a later run with the same camera.
  const StereoEvidence& evidence() const { return evidence_; }
  void SetEvidence(const StereoEvidence& evidence) { evidence_ = evidence; }

 private:
  RectifiedCamera camera_;
  StereoEvidence evidence_;
};

// Applies another stereo correction to all keyframes of a map, at a cost for each step that does
// not grow with the map. Each step prepares the features of some keyframes; when all are prepared,
// the map gets them at once. Until then the whole map keeps the old correction. A map of no more
// than kSlice keyframes changes with the first step.
//
// The keyframe at which the change takes effect depends on the map alone. Not thread-safe.
class StereoChange {
 public:
  // Number of keyframes prepared in one step, some microseconds each.
  static constexpr std::size_t kSlice = 256;

  bool Running(const Map& map) const { return state_ && state_->map == map.id(); }
  // Begins a change of this map and cancels one in progress.
  void Begin(const Map& map, const StereoCorrection& correction);
  // Does one step of the change in progress for this map, if any.
  void Step(Map& map);
  void GiveUp();
  // Gives up a change of a map that has been joined to another one, which has its own correction.
  void FollowJoins(const Atlas& atlas);
  // The correction that the map is about to get. Only where a change is running.
  const StereoCorrection& correction() const { return state_->correction; }

 private:
  struct State {
    MapId map;
    StereoCorrection correction;
    KeyFrameId next{0};  // the keyframes before this one are ready
  };

  std::optional<State> state_;
  edit::CorrectFeatures change_;
  // Replaced features. They are freed step by step, since freeing takes time.
  std::deque<std::shared_ptr<const FrameFeatures>> retired_;
};

}  // namespace plumbline

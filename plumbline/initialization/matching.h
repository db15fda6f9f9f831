// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/features/match_lines.h"
#include "plumbline/features/match_points.h"
#include "plumbline/features/types.h"
#include "plumbline/geometry/rectified_camera.h"
#include "plumbline/geometry/segment.h"
#include "plumbline/solvers/relative_pose.h"

#include <span>
#include <vector>

#include <Eigen/Core>

namespace plumbline {

// Pixels of one point in two images.
struct PixelPair {
  Eigen::Vector2d from = Eigen::Vector2d::Zero();
  Eigen::Vector2d to = Eigen::Vector2d::Zero();
};

// Predicts the position of pixels of one image in another from matches. An affine map is fitted
// robustly to all of them. Parallax moves near objects further than far ones, so that the median
// residual of the map at the nearest matches is added.
class ImageMotion {
 public:
  ImageMotion() = default;  // nothing moves
  // Fits the motion. With fewer than three pairs (or with all of them collinear) it is their median
  // shift. Cost: O(n).
  explicit ImageMotion(std::span<const PixelPair> matches);

  // Returns true if the motion was fitted to matches.
  bool known() const { return !places_.empty(); }

  // The derivative of the affine map.
  const Eigen::Matrix2d& linear() const { return linear_; }

  // Predicts the position of a pixel. Cost: O(n).
  Eigen::Vector2d operator()(const Eigen::Vector2d& px) const;
  Segment2 operator()(const Segment2& segment) const {
    return {(*this)(segment.start), (*this)(segment.end)};
  }

 private:
  Eigen::Vector2d Affine(const Eigen::Vector2d& px) const {
    return linear_ * (px - origin_) + shift_;
  }

  // The affine map: px -> linear (px - origin) + shift.
  Eigen::Matrix2d linear_ = Eigen::Matrix2d::Identity();
  Eigen::Vector2d origin_ = Eigen::Vector2d::Zero();
  Eigen::Vector2d shift_ = Eigen::Vector2d::Zero();
  std::vector<Eigen::Vector2d> places_;     // positions of the matches, in the first image
  std::vector<Eigen::Vector2d> leftovers_;  // residuals of the affine map at places_
};

// Matches of the features of a reference frame (a) in a later frame (b).
struct ReferenceMatches {
  std::vector<FeatureMatch> points;  // ordered by feature of the reference
  std::vector<FeatureMatch> lines;
  ImageMotion motion;  // motion from the reference to the frame, a guess for the next frame
};

// Matches the points and lines of a reference frame with those of a later frame by descriptor.
//
// Points are matched twice. The first time they are searched in a wide window around the position
// predicted by `guess` (50 px to each side; 100 px without a guess). Of these only matches are kept
// whose orientation fits the roll of the camera (15 degrees) and whose displacement fits that of
// their neighbours. The second time all points are searched in a narrow window (25 px) around the
// position predicted by those matches. Lines follow, moved by the same motion.
//
//   guess    motion to an earlier frame close to this one; a default one for the first frame
//   returns  at most one match for each feature
//   cost     about 5 ms for 1000 points and 200 lines, less with a guess
ReferenceMatches MatchToReference(const Features& reference,
                                  const Features& frame,
                                  const ImageMotion& guess = {});

}  // namespace plumbline

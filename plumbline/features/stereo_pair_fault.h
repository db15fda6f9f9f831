// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/image/rectify.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace plumbline {

// What is wrong with the images of a stereo pair, or with their calibration. "Upside down" is a
// turn by 180 degrees.
enum class StereoPairFault {
  kLeftTwice,     // the right images are the left ones
  kSidesSwapped,  // the right images were taken by the left camera, and the reverse
  kRightLate,     // the right images belong to the left ones of the frame before
  kRightEarly,    // the right images belong to the left ones of the frame after
  kRightUpsideDown,
  kLeftUpsideDown,
  kOneMirrored,       // one side is mirrored, left to right or top to bottom
  kRectifiedAlready,  // corresponding points lie in equal rows as delivered
  kOtherCameras       // corresponding points are in other rows, for none of the reasons above
};

// Returns the fault in one sentence for users: what fits better, and a question. With `backwards`
// the frames are played from the last to the first.
std::string Describe(StereoPairFault fault, bool backwards = false);

// A point of a left image and one of a right image that look alike, in pixels as delivered.
struct StereoPairMatch {
  std::size_t left_index = 0;  // number of the point among those of the left image
  Eigen::Vector2d left;
  Eigen::Vector2d right;
};

// The left image of a frame matched with right images, over the whole image and without regard to
// the calibration. Sets that nobody asked for are empty.
struct StereoPairSample {
  std::size_t left_points = 0;
  std::vector<StereoPairMatch> own;       // with the right image of the frame
  std::vector<StereoPairMatch> before;    // with that of the frame before
  std::vector<StereoPairMatch> after;     // with that of the frame after
  std::vector<StereoPairMatch> mirrored;  // with its own, whose columns are in reverse order
  // Mean difference of the frame's two images, relative to the mean deviation of the left one from
  // its mean: 0 for a copy, about 1 for images that have nothing to do with each other.
  double difference = 0;
};

// Returns how many of the sample's own matches fit the calibration: rectified, both points are in
// the same row, and the disparity is not negative.
std::size_t CountFitting(const Rectifier& rectifier, const StereoPairSample& sample);

// Returns the fault that the samples show beyond doubt; nullopt: none.
//
// A reading of the images undoes what may have happened to them: the sides exchanged, an image
// turned, the right image of the next frame in place of the frame's own. It is true if most of its
// matches fit, many left points have a match that fits with it alone, and hardly any have one that
// fits as delivered alone, in at least three samples. Where everything is far away, where there is
// little to match, and for late images where the camera stands still, both are alike and nothing is
// told. A smooth error of the rows of up to 1 % of the width, as of a calibration that is not
// exact, counts as fitting. Cost: some microseconds for each match.
std::optional<StereoPairFault> FindStereoPairFault(const Rectifier& rectifier,
                                                   const std::vector<StereoPairSample>& samples);

}  // namespace plumbline

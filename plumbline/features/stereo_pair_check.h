// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/features/types.h"
#include "plumbline/image/image.h"
#include "plumbline/image/rectify.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace plumbline {

// Faults of the images of a stereo pair, or of their calibration. "Upside down" is a rotation by
// 180 degrees.
enum class StereoPairFault {
  kLeftTwice,     // the right images are the left ones
  kSidesSwapped,  // left and right images are exchanged
  kRightLate,     // the right images belong to the left ones of the frame before
  kRightEarly,    // the right images belong to the left ones of the frame after
  kRightUpsideDown,
  kLeftUpsideDown,
  kOneMirrored,       // one side is mirrored, left to right or top to bottom
  kRectifiedAlready,  // corresponding points lie in equal rows as delivered
  kOtherCameras       // corresponding points are in other rows, for none of the reasons above
};

// Returns the fault in one sentence for users: the better interpretation, and a question.
std::string Describe(StereoPairFault fault);

// A match of a left and a right image by descriptors, in pixels as delivered.
struct StereoPairMatch {
  std::size_t left_index = 0;  // index of the point in the left image
  Eigen::Vector2d left;
  Eigen::Vector2d right;
};

// The left image of a frame matched with right images, over the whole image, without the
// calibration. Unrequested sets are empty.
struct StereoPairSample {
  std::size_t left_points = 0;
  std::vector<StereoPairMatch> own;       // with the right image of the frame
  std::vector<StereoPairMatch> before;    // with that of the frame before
  std::vector<StereoPairMatch> after;     // with that of the frame after
  std::vector<StereoPairMatch> mirrored;  // with its own right image, mirrored left to right
  // Mean difference of the frame's two images, relative to the mean deviation of the left one from
  // its mean: 0 for a copy, about 1 for unrelated images.
  double difference = 0;
};

// Returns the number of the sample's own matches that fit the calibration: rectified, both points
// are in the same row, and the disparity is not negative.
std::size_t CountFitting(const Rectifier& rectifier, const StereoPairSample& sample);

// Returns the fault that the samples prove; nullopt: none.
//
// An interpretation reverses a possible fault: the sides exchanged, an image turned, the right
// image of the next frame in place of the frame's own. It is accepted if most of its matches fit,
// many left points have a match that fits only under it, and hardly any have one that fits only as
// delivered, in at least three samples. If everything is far away, if matches are few, and for late
// images of a camera at rest, both fit alike and no fault is reported. A smooth error of the rows
// of up to 1 % of the width, as of an inexact calibration, counts as fitting. Cost: some
// microseconds for each match.
std::optional<StereoPairFault> FindStereoPairFault(const Rectifier& rectifier,
                                                   const std::vector<StereoPairSample>& samples);

// Checks some of the first frames of a stereo sequence: the images must fit the calibration, and
// not fit it far better under another interpretation (FindStereoPairFault). Matches ORB points of
// the images as delivered.
//
// Deterministic, not thread-safe. Cost: two images for each sample, at some 4 ms (752x480), and two
// or three more for samples that fit badly.
class StereoPairCheck {
 public:
  // Keeps a reference to the rectifier. Without a right camera no fault is ever found.
  explicit StereoPairCheck(const Rectifier& rectifier) : rectifier_(rectifier) {}

  // Returns true if Add uses the frame at this position of the sequence: the samples at 1, 6, 11,
  // 16, 21, 60 and 180, and the frames before and after them.
  static bool LooksAt(std::size_t position);

  // Adds a frame as delivered, by ascending position; some may be missing. Ignores a frame that
  // LooksAt rejects, without right image or of another size than calibrated, and any frame after a
  // fault was found. Returns the fault if this frame reveals one.
  std::optional<StereoPairFault> Add(std::size_t position, const SensorFrame& frame);

 private:
  void Begin(const SensorFrame& frame);
  std::vector<StereoPairMatch> MatchWith(const GrayImage& right) const;
  bool Usable(const SensorFrame& frame) const;

  const Rectifier& rectifier_;
  std::vector<StereoPairSample> samples_;
  std::vector<PointFeature> left_;  // points of the last sample's left image
  bool waits_ = false;              // the last sample waits for the next frame
  bool fits_badly_ = false;         // and it needs its right image
  std::optional<GrayImage> right_before_;
  std::size_t position_before_ = 0;  // position of its frame
  bool done_ = false;
};

}  // namespace plumbline

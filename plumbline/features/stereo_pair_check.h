// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/features/stereo_pair_fault.h"
#include "plumbline/features/types.h"
#include "plumbline/image/image.h"
#include "plumbline/image/rectify.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace plumbline {

// Looks at some of the first frames of a stereo sequence and finds out whether the images fit the
// calibration, or fit it far better when they are taken for something else (FindStereoPairFault).
// It matches ORB points of the images as delivered.
//
// Deterministic, not thread-safe. Cost: two images for each sample, at some 4 ms (752x480), and two
// or three more for samples that fit badly.
class StereoPairCheck {
 public:
  // Keeps a reference to the rectifier. Without a right camera nothing is ever found.
  explicit StereoPairCheck(const Rectifier& rectifier) : rectifier_(rectifier) {}

  // Whether Add makes use of the frame at this position of the sequence: the samples at 1, 6, 11,
  // 16, 21, 60 and 180, and the frames before and after them.
  static bool LooksAt(std::size_t position);

  // Takes a frame as delivered. Frames come by rising position; some may be missing. A frame that
  // LooksAt does not want, that has no right image or another size than the calibration says, and
  // any frame after a fault was found, does nothing. Returns the fault where this frame shows one.
  std::optional<StereoPairFault> Add(std::size_t position, const SensorFrame& frame);

 private:
  void Begin(const SensorFrame& frame);
  std::vector<StereoPairMatch> MatchWith(const GrayImage& right) const;
  bool Usable(const SensorFrame& frame) const;

  const Rectifier& rectifier_;
  std::vector<StereoPairSample> samples_;
  std::vector<PointFeature> left_;  // points of the last sample's left image
  bool waits_ = false;              // the last sample waits for the next frame
  bool fits_badly_ = false;         // and needs its right image
  std::optional<GrayImage> right_before_;
  std::size_t position_before_ = 0;  // of the frame that it belongs to
  bool done_ = false;
};

}  // namespace plumbline

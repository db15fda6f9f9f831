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

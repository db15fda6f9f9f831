// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/features/types.h"
#include "plumbline/map/map.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace plumbline {

// Point features that stand still in the image from keyframe to keyframe: text, or a part of what
// carries the camera.
struct StillFeatures {
  std::size_t pairs = 0;       // pairs of keyframes between which the camera moved
  std::size_t with_still = 0;  // pairs in which many features stand still
  double share = 0;            // mean share of the features that stand still in these

  // True if something is likely to be in most images that does not belong to the scene.
  bool Likely() const;
};

// Compares the features of images, in the order of time, each with those of the fifth before it.
class StillFeatureFinder {
 public:
  void Add(std::vector<PointFeature> points);
  // Forgets the images so far, but not what was found in them.
  void Restart() { last_.clear(), number_ = 0; }
  StillFeatures Result() const;

 private:
  std::vector<std::vector<PointFeature>> last_;  // of the images before, a ring
  std::size_t number_ = 0;                       // of images since the start
  StillFeatures found_;
  double shares_ = 0;
};

// Compares each keyframe with the fifth before it, of the same session: features of one octave
// within a pixel of each other stand still, but for as many as do so by chance. Descriptors are not
// compared, since around thin text they show the scene. Pairs in which most features stand still
// are of a camera that rests, and do not count. O(features of all keyframes).
StillFeatures FindStillFeatures(const Map& map);

// Returns the note about them for users; nullopt if they are not likely to be in most images.
std::optional<std::string> StillFeaturesNote(const StillFeatures& still);

}  // namespace plumbline

// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/map.h"

#include <cstddef>
#include <optional>
#include <string>

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

// Compares each keyframe with the fifth before it, of the same session: features within a pixel of
// each other and with similar descriptors stand still. Pairs in which most features do are of a
// camera that rests, and do not count. O(features of all keyframes).
StillFeatures FindStillFeatures(const Map& map);

// Returns the note about them for users; nullopt if they are not likely to be in most images.
std::optional<std::string> StillFeaturesNote(const StillFeatures& still);

}  // namespace plumbline

// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/initialization/initializer.h"
#include "plumbline/initialization/track_factorization.h"
#include "plumbline/initialization/tracks.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace plumbline {

// The start of a map as the first paper describes it (Lee and Hwang 2019, section 2), corrected
// where a formula is wrong (docs/methods/rippl.md).
//
// Points are matched with the reference by descriptor. Once there are m = options.frames frames
// after it, the newest m successive ones are taken: each gets its pose against the reference by
// itself (EstimatePairwisePose), matches far from their epipolar lines are left out, places that a
// frame does not show are interpolated where the epipolar lines meet at an angle, and rank-1
// factorization gives all centres and inverse distances (FactorizePairwise). What can be
// triangulated of it is the map, at once: nothing decides whether it is good enough but that there
// are landmarks.
class PairwiseInitializer : public Initializer {
 public:
  PairwiseInitializer(const CameraAndPyramid& imaging,
                      const InitializationOptions& options,
                      std::uint64_t seed);

  InitializationResult Add(const InitializationFrame& frame) override;
  void Reset() override { window_.Reset(); }

 private:
  // Finds the pose of each view and leaves out of the tracks what does not fit it; empty where one
  // has none.
  std::vector<Rigid3> EstimatePoses(FrameId newest, FeatureTracks& tracks);
  std::optional<InitialMap> MakeMap(const std::vector<int>& frames,
                                    const Reconstruction& found) const;

  RectifiedCamera camera_;
  InitializationOptions options_;
  FactorizationOptions factorization_;
  std::uint64_t seed_;
  InitializationWindow window_;
};

}  // namespace plumbline

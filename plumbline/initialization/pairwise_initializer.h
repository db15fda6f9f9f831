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

// Initialization of the first paper (Lee and Hwang 2019, section 2), with formulas corrected
// (docs/methods/rippl.md).
//
// Points are matched with the reference by descriptor. Once there are m = options.frames frames
// after it, the newest m successive ones are taken: each gets its pose relative to the reference by
// itself (EstimatePairwisePose), matches far from their epipolar lines are left out, missing
// positions are interpolated where the epipolar lines meet at an angle, and rank-1 factorization
// gives all centres and inverse distances (FactorizePairwise). The landmarks that can be
// triangulated are the map, at once: the only criterion is that there are some.
class PairwiseInitializer : public Initializer {
 public:
  PairwiseInitializer(const CameraAndPyramid& imaging,
                      const InitializationOptions& options,
                      std::uint64_t seed);

  InitializationResult Add(const InitializationFrame& frame) override;
  void Reset() override { window_.Reset(); }

 private:
  // Estimates the pose of each view and removes outliers from the tracks; empty if a view has no
  // pose.
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

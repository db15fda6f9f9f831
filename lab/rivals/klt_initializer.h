// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/initialization/initializer.h"
#include "plumbline/initialization/klt_tracks.h"
#include "plumbline/initialization/tracks.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace plumbline {

// Rank-1 factorization as in the initialization of GSLAM by Tang et al., for comparison. The
// features of the reference are tracked by KLT, and only points tracked in all frames are
// factorized. There is no interpolation, each frame has its best relative pose by itself, and
// simple thresholds decide: the share of points in front, the residual of the factorization, the
// median parallax.
//
// Needs the images of all frames (BugError otherwise). If too few tracks remain, the present frame
// becomes the reference.
class KltInitializer : public Initializer {
 public:
  KltInitializer(const RectifiedCamera& camera,
                 const InitializationOptions& options,
                 std::uint64_t seed,
                 HelperThread* helper = nullptr);

  InitializationResult Add(const InitializationFrame& frame) override;
  void Reset() override;

 private:
  struct Followed {
    InitializationFrame frame;
    TrackedPixels places;  // pixels of the reference's features
  };

  void Start(const InitializationFrame& frame);
  // Returns frames spread evenly since the reference, the newest last.
  std::vector<int> SelectFrames() const;
  // Returns the points still tracked in the newest frame, in the selected frames.
  FeatureTracks CollectTracks(const std::vector<int>& frames) const;
  InitializationResult Attempt();
  std::optional<InitialMap> BuildMap(const std::vector<int>& frames,
                                     const std::vector<Rigid3>& poses) const;

  RectifiedCamera camera_;
  int frame_count_;  // number of frames factorized together
  std::uint64_t seed_;
  HelperThread* helper_;
  std::optional<InitializationFrame> reference_;
  KltTracks tracks_;
  std::vector<Followed> frames_;
};

}  // namespace plumbline

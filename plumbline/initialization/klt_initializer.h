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

// Rank-1 factorization as Tang et al. start GSLAM, for comparison: the features of the reference
// are followed by KLT, and only points alive in all frames are factorized. No interpolation, the
// best relative pose of each frame by itself, and a decision by simple thresholds: share of points
// in front, residual of the factorization, median parallax.
//
// Needs the images of all frames (BugError otherwise). The reference is given up for the present
// frame when too few tracks are left.
class KltInitializer : public Initializer {
 public:
  KltInitializer(const RectifiedCamera& camera,
                 const InitializationOptions& options,
                 std::uint64_t seed);

  InitializationResult Add(const InitializationFrame& frame) override;
  void Reset() override;
  void Save(StateWriter& archive) const override;
  void Load(StateReader& archive) override;

  // False for what was read and no initializer can have: places and images that do not go together.
  bool IsConsistent() const;

  // All that it keeps (base/byte_format.h).
  template <class Self, class Visitor>
  static void VisitState(Self& self, const Visitor& visit) {
    visit(self.reference_, self.tracks_, self.frames_);
  }

 private:
  struct Followed {
    InitializationFrame frame;
    TrackedPixels places;  // where the reference's features are

    template <class Self, class Visitor>
    static void VisitState(Self& self, const Visitor& visit) {
      visit(self.frame, self.places);
    }
  };

  void Start(const InitializationFrame& frame);
  // Frames spread evenly since the reference, the newest last.
  std::vector<int> SelectFrames() const;
  // The points alive in the newest frame, in the chosen frames.
  Tracks CollectTracks(const std::vector<int>& frames) const;
  InitializationResult Attempt();
  std::optional<InitialMap> BuildMap(const std::vector<int>& frames,
                                     const std::vector<Rigid3>& poses) const;

  RectifiedCamera camera_;
  int frame_count_;  // that are factorized together
  std::uint64_t seed_;
  std::optional<InitializationFrame> reference_;
  KltTracks tracks_;
  std::vector<Followed> frames_;
};

}  // namespace plumbline

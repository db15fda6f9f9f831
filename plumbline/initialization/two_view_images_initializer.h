// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/initialization/two_view.h"
#include "plumbline/initialization/window_initializer.h"

#include <cstdint>
#include <optional>

#include <Eigen/Core>

namespace plumbline {

// The conventional decision (SolveTwoViews) on what rank1 sees: points are followed and aligned on
// the images (FrameWindow), and the reference stays until matches with it die out. Beside rank1 it
// tells what factorization and the decision of several frames bring, beside two_view what the
// matches bring.
//
// Each frame is tried alone, with all points that it shows of the reference. Needs the images of
// all frames (BugError otherwise).
class TwoViewImagesInitializer : public WindowInitializer {
 public:
  TwoViewImagesInitializer(const ImagingModel& imaging, std::uint64_t seed)
      : WindowInitializer(imaging.camera, InitialMatching::kImages, 1),
        camera_(imaging.camera),
        seed_(seed) {}

  void Save(StateWriter& archive) const override;
  void Load(StateReader& archive) override;

  // All that it keeps (base/byte_format.h).
  template <class Self, class Visitor>
  static void VisitState(Self& self, const Visitor& visit) {
    visit(self.window_, self.most_matches_);
  }

 private:
  InitializationResult Attempt() override;
  // From the points that go with the pose, where the image shows them; nullopt where too little is
  // left.
  std::optional<InitialMap> BuildMap(const WindowTracks& tracks,
                                     const TwoViewSolution& solution) const;

  RectifiedCamera camera_;
  std::uint64_t seed_;
};

}  // namespace plumbline

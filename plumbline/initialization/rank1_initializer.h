// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/initialization/frame_window.h"
#include "plumbline/initialization/initializer.h"
#include "plumbline/initialization/multi_view.h"

#include <cstdint>

namespace plumbline {

// The first paper's start of a map (section 2): rank-1 factorization of several frames, completed
// by geometric interpolation, with a decision that waits rather than errs (multi_view.h).
//
// The first frame with enough features is the reference. Each later one is matched with it and
// kept; from options.frames of them on, a window spread over all of them is tried anew with each
// frame. The reference moves forward only when matches with it die out.
class Rank1Initializer : public Initializer {
 public:
  Rank1Initializer(const ImagingModel& imaging,
                   const InitializationOptions& options,
                   std::uint64_t seed);

  InitializationResult Add(const InitializationFrame& frame) override;
  void Reset() override;
  void Save(StateWriter& archive) const override;
  void Load(StateReader& archive) override;

  // All that it keeps (base/byte_format.h).
  template <class Self, class Visitor>
  static void VisitState(Self& self, const Visitor& visit) {
    visit(self.window_, self.memory_, self.most_matches_);
  }

 private:
  InitializationResult Attempt();

  ImagingModel imaging_;
  InitializationOptions options_;
  WindowDecisionOptions decision_;
  std::uint64_t seed_;
  FrameWindow window_;
  WindowMemory memory_;
  int most_matches_ = 0;  // with the present reference
};

}  // namespace plumbline

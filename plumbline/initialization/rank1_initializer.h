// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/initialization/multi_view.h"
#include "plumbline/initialization/window_initializer.h"

#include <cstdint>

namespace plumbline {

// The first paper's start of a map (section 2): rank-1 factorization of several frames, completed
// by geometric interpolation, with a decision that waits rather than errs (multi_view.h).
//
// From options.frames frames after the reference on, a window spread over all of them is tried anew
// with each frame.
class Rank1Initializer : public WindowInitializer {
 public:
  Rank1Initializer(const ImagingModel& imaging,
                   const InitializationOptions& options,
                   std::uint64_t seed);

  void Save(StateWriter& archive) const override;
  void Load(StateReader& archive) override;

  // All that it keeps (base/byte_format.h).
  template <class Self, class Visitor>
  static void VisitState(Self& self, const Visitor& visit) {
    visit(self.window_, self.memory_, self.most_matches_);
  }

 private:
  InitializationResult Attempt() override;
  void ForgetReference() override { memory_.Clear(); }

  ImagingModel imaging_;
  InitializationOptions options_;
  WindowDecisionOptions decision_;
  std::uint64_t seed_;
  WindowMemory memory_;
};

}  // namespace plumbline

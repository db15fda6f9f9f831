// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/initialization/model_selection.h"
#include "plumbline/initialization/tracks.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace plumbline {

// Initialization of the first paper (section 2): rank-1 factorization of several frames, completed
// by geometric interpolation, with a decision that prefers waiting to errors (model_selection.h).
//
// Attempts begin once there are options.frames frames after the reference. Each attempt takes that
// many frames, spread over all frames since the reference, and each new frame leads to another
// attempt.
class Rank1Initializer : public Initializer {
 public:
  Rank1Initializer(const CameraAndPyramid& imaging,
                   const InitializationOptions& options,
                   std::uint64_t seed,
                   HelperThread* helper = nullptr);

  InitializationResult Add(const InitializationFrame& frame) override;
  void Reset() override;

 private:
  std::optional<MeasuredTurns> TurnsOf(const std::vector<int>& frames) const;

  RectifiedCamera camera_;
  int frames_;  // m of the paper
  ModelSelectionOptions selection_;
  std::uint64_t seed_;
  InitializationWindow window_;
  PriorHypotheses prior_;
};

}  // namespace plumbline

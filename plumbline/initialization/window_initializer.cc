// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/initialization/window_initializer.h"

#include <algorithm>

namespace plumbline {
namespace {

constexpr int kMinFeatures = 60;  // of a frame that is taken into the window

// Whether few matches with a reference are left, absolutely or of the most there were with it;
// those are more and more often wrong.
bool HaveDiedOut(int matches, int most_matches) {
  constexpr int kFewest = 12;
  constexpr double kShare = 0.3;
  return matches < std::max<double>(kFewest, kShare * most_matches);
}

}  // namespace

void WindowInitializer::Reset() {
  window_.Reset();
  ForgetReference();
  most_matches_ = 0;
}

InitializationResult WindowInitializer::Add(const InitializationFrame& frame) {
  using enum InitializationWait;
  if (static_cast<int>(frame.indexed->features.points.size()) < kMinFeatures) {
    return InitializationResult::Wait(kTooFewFeatures);
  }
  if (window_.empty()) {
    window_.Add(frame);
    return InitializationResult::Wait(kTooFewFrames);
  }
  InitializationResult result;
  const int matches = window_.Add(frame);
  most_matches_ = std::max(most_matches_, matches);
  if (HaveDiedOut(matches, most_matches_)) {
    window_.MoveReference();
    ForgetReference();
    most_matches_ = 0;
    result.wait = kTooFewMatches;
  } else if (window_.size() < needed_) {
    result.wait = kTooFewFrames;
  } else {
    result = Attempt();
  }
  result.matches = matches;
  return result;
}

}  // namespace plumbline

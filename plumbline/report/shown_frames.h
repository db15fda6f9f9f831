// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/slam/frame_log.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

namespace plumbline {

// Returns the n with which every n-th of `count` items are at most `limit`.
inline std::size_t StepFor(std::size_t count, std::size_t limit) {
  return std::max<std::size_t>(1, (count + limit - 1) / std::max<std::size_t>(limit, 1));
}

// Keeps the first of every `step` items.
template <class T>
void KeepEvery(std::size_t step, std::vector<T>& things) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < things.size(); i += step) things[kept++] = things[i];
  things.resize(kept);
}

// Frames of a run that a page shows individually, each a row of its charts. A page with all frames
// of a day would take gigabytes, on disk and in the browser: of a run with more frames than `limit`
// these are every n-th frame, the last one, those before and after a change of state (a loss begins
// or ends), and requested ones.
class ShownFrames {
 public:
  static constexpr std::size_t kMost = 100'000;

  // always: frames shown in any case. At most limit + 1 frames are added to them and to the
  // changes, which are thinned in the same way.
  ShownFrames(const FrameLog& frames,
              const std::vector<std::size_t>& always,
              std::size_t limit = kMost);

  // The numbers of the frames, in order; a frame's row is its index here.
  const std::vector<std::size_t>& numbers() const { return numbers_; }
  // 1 if all frames are shown, otherwise the n of every n-th frame.
  std::size_t step() const { return step_; }
  // Returns the row of a frame; nullopt if it is not shown. O(log frames).
  std::optional<std::size_t> RowOf(std::size_t frame) const;

 private:
  std::size_t step_ = 1;
  std::vector<std::size_t> numbers_;
};

}  // namespace plumbline

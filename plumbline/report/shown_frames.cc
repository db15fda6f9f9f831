// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/report/shown_frames.h"

#include <algorithm>

namespace plumbline {
namespace {

// Returns the frames whose state is another one than that of the frame before.
std::vector<std::size_t> ChangesOfState(const FrameLog& frames) {
  std::vector<std::size_t> changes;
  for (std::size_t i = 1; i < frames.size(); ++i) {
    if (frames.StatusOf(i) != frames.StatusOf(i - 1)) changes.push_back(i);
  }
  return changes;
}

}  // namespace

ShownFrames::ShownFrames(const FrameLog& frames,
                         const std::vector<std::size_t>& always,
                         std::size_t limit)
    : step_(StepFor(frames.size(), limit)) {
  for (std::size_t i = 0; i < frames.size(); i += step_) numbers_.push_back(i);
  if (step_ == 1) return;
  numbers_.push_back(frames.size() - 1);
  std::vector<std::size_t> changes = ChangesOfState(frames);
  KeepEvery(StepFor(changes.size(), limit), changes);
  for (const std::size_t i : changes) numbers_.insert(numbers_.end(), {i - 1, i});
  for (const std::size_t i : always) {
    if (i < frames.size()) numbers_.push_back(i);
  }
  std::sort(numbers_.begin(), numbers_.end());
  numbers_.erase(std::unique(numbers_.begin(), numbers_.end()), numbers_.end());
}

std::optional<std::size_t> ShownFrames::RowOf(std::size_t frame) const {
  const auto found = std::lower_bound(numbers_.begin(), numbers_.end(), frame);
  if (found == numbers_.end() || *found != frame) return std::nullopt;
  return static_cast<std::size_t>(found - numbers_.begin());
}

}  // namespace plumbline

// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/progress.h"

#include "plumbline/base/options.h"

#include <algorithm>
#include <iostream>

#include <fmt/format.h>
#include <unistd.h>

namespace plumbline {
namespace {

constexpr std::chrono::seconds kLineEvery(5);
constexpr std::chrono::milliseconds kBarEvery(100);

std::string Bar(std::size_t done, std::size_t total) {
  constexpr std::size_t kWidth = 24;
  const std::size_t filled = kWidth * done / std::max<std::size_t>(total, 1);
  return "[" + std::string(filled, '#') + std::string(kWidth - filled, '.') + "] ";
}

}  // namespace

Progress::Progress(std::size_t total, bool quiet)
    : total_(total), quiet_(quiet), terminal_(isatty(2) != 0) {}

void Progress::Show(const FrameRecord& frame) {
  const auto now = Clock::now();
  const auto done = static_cast<std::size_t>(frame.id.value) + 1;
  keyframes_ += frame.keyframe;
  const bool last = done == total_;
  const auto interval = terminal_ ? Clock::duration(kBarEvery) : Clock::duration(kLineEvery);
  if (quiet_ || (!last && now - shown_ < interval)) return;
  shown_ = now;
  const double seconds = std::chrono::duration<double>(now - start_).count();
  const double fps = static_cast<double>(done) / std::max(seconds, 1e-9);
  const double left = static_cast<double>(total_ - done) / std::max(fps, 1e-9);
  const std::string text = fmt::format("{}{}/{} frames  {:.1f} fps  {}  {} keyframes  ETA {:.0f} s",
                                       terminal_ ? Bar(done, total_) : std::string(),
                                       done,
                                       total_,
                                       fps,
                                       NameOf(frame.status),
                                       keyframes_,
                                       left);
  std::cerr << (terminal_ ? '\r' + text + "   " + (last ? "\n" : "") : text + '\n') << std::flush;
}

void Progress::Say(const std::string& message) const {
  std::cerr << (terminal_ ? "\n" : "") + ("plumbline: " + message + '\n');
}

}  // namespace plumbline

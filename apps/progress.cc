// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/progress.h"

#include "plumbline/base/options.h"

#include <algorithm>
#include <iostream>
#include <utility>

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

Countdown::Countdown(std::string what, std::size_t total)
    : what_(std::move(what)), total_(total), terminal_(isatty(2) != 0) {}

void Countdown::Show(std::size_t done, const std::string& note) {
  const auto now = Clock::now();
  const bool last = done == total_;
  const auto interval = terminal_ ? Clock::duration(kBarEvery) : Clock::duration(kLineEvery);
  if (!last && now - shown_ < interval) return;
  shown_ = now;
  const double seconds = std::chrono::duration<double>(now - start_).count();
  const double per_second = static_cast<double>(done) / std::max(seconds, 1e-9);
  const double left = static_cast<double>(total_ - done) / std::max(per_second, 1e-9);
  const std::string text = fmt::format("{}{}/{} {}  {:.1f} per second  {}ETA {:.0f} s",
                                       terminal_ ? Bar(done, total_) : std::string(),
                                       done,
                                       total_,
                                       what_,
                                       per_second,
                                       note.empty() ? "" : note + "  ",
                                       left);
  std::cerr << (terminal_ ? '\r' + text + "   " + (last ? "\n" : "") : text + '\n') << std::flush;
}

Progress::Progress(std::size_t total, bool quiet)
    : quiet_(quiet), terminal_(isatty(2) != 0), countdown_("frames", total) {}

void Progress::Show(const FrameRecord& frame) {
  keyframes_ += frame.keyframe;
  if (quiet_) return;
  countdown_.Show(static_cast<std::size_t>(frame.id.value) + 1,
                  fmt::format("{}  {} keyframes", NameOf(frame.status), keyframes_));
}

void Progress::Say(const std::string& message) const {
  std::cerr << (terminal_ ? "\n" : "") + ("plumbline: " + message + '\n');
}

}  // namespace plumbline

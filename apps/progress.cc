// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/progress.h"

#include "plumbline/base/options.h"
#include "plumbline/base/printable.h"

#include <algorithm>
#include <iostream>

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

namespace plumbline {
namespace {

constexpr std::chrono::milliseconds kBarEvery(100);

std::string Bar(std::size_t done, std::size_t total) {
  constexpr std::size_t kWidth = 24;
  const std::size_t filled = kWidth * done / std::max<std::size_t>(total, 1);
  return "[" + std::string(filled, '#') + std::string(kWidth - filled, '.') + "] ";
}

// Cut at the width of the terminal, since a wrapped line cannot be overwritten; padded to cover the
// previous line.
std::string OneLine(const std::string& text) {
  winsize window{};
  const bool known = ::ioctl(STDERR_FILENO, TIOCGWINSZ, &window) == 0 && window.ws_col > 1;
  std::string line = text;
  line.resize(known ? window.ws_col - 1U : std::max<std::size_t>(text.size(), 100), ' ');
  return line;
}

}  // namespace

ProgressLine::ProgressLine(bool quiet, std::chrono::milliseconds every)
    : quiet_(quiet), terminal_(isatty(STDERR_FILENO) != 0), every_(terminal_ ? kBarEvery : every) {}

void ProgressLine::Show(std::size_t done, std::size_t total, const std::string& text) {
  const auto now = Clock::now();
  const bool last = done == total;
  if (quiet_ || (!last && now - shown_ < every_)) return;
  shown_ = now;
  std::clog << (terminal_ ? '\r' + OneLine(Bar(done, total) + text) + (last ? "\n" : "")
                          : text + '\n')
            << std::flush;
}

void ProgressLine::ShowOpen(const std::string& text) {
  const auto now = Clock::now();
  if (quiet_ || now - shown_ < every_) return;
  shown_ = now;
  std::clog << (terminal_ ? '\r' + OneLine(text) : text + '\n') << std::flush;
}

void ProgressLine::End() const {
  if (!quiet_ && terminal_) std::clog << std::endl;
}

void ProgressLine::Say(const std::string& message) const {
  std::clog << (terminal_ ? "\n" : "") +
                   ("plumbline: " + Printable(message, kLongestMessage) + '\n');
}

void Countdown::Show(std::size_t done, const std::string& note) {
  const double seconds = std::chrono::duration<double>(Clock::now() - start_).count();
  const double per_second = static_cast<double>(done) / std::max(seconds, 1e-9);
  const std::string rest = note.empty() ? "" : note + "  ";
  if (!total_) {
    line_.ShowOpen(fmt::format("{} {}  {:.1f} per second  {}", done, what_, per_second, rest));
    return;
  }
  const double left = static_cast<double>(*total_ - done) / std::max(per_second, 1e-9);
  line_.Show(done,
             *total_,
             fmt::format("{}/{} {}  {:.1f} per second  {}ETA {:.0f} s",
                         done,
                         *total_,
                         what_,
                         per_second,
                         rest,
                         left));
}

void Progress::Show(const FrameRecord& frame) {
  countdown_.Show(static_cast<std::size_t>(frame.id.value) + 1, NameOf(frame.status));
}

AdjustmentProgress::~AdjustmentProgress() {
  if (shown_ != start_) line_.End();
}

// The caller asks for each point of the map; text is made for few of these calls.
void AdjustmentProgress::Show() {
  const auto now = Clock::now();
  if (now - shown_ < kBarEvery) return;
  shown_ = now;
  const double seconds = std::chrono::duration<double>(now - start_).count();
  line_.ShowOpen(fmt::format("adjusting the map  {:.0f} s", seconds));
}

}  // namespace plumbline

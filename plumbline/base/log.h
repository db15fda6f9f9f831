// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <utility>

#include <fmt/core.h>

namespace plumbline {

// The library logs at trace (per frame), debug, and warning (recovered with a worse result); errors
// are returned or thrown, never logged. Info is for the programs in apps/.
enum class LogLevel { kTrace, kDebug, kInfo, kWarning, kOff };

// Messages below `level` are dropped. At the start: kWarning. Messages go to standard error.
void SetLogLevel(LogLevel level);
bool LogEnabled(LogLevel level);

// Writes one line. Thread-safe.
void LogText(LogLevel level, std::string_view text);

// Logs with fmt formatting, done only when the level is enabled:
//   Log(LogLevel::kDebug, "keyframe {}: {} points", id, count);
template <class... Args>
void Log(LogLevel level, fmt::format_string<Args...> format, Args&&... args) {
  if (LogEnabled(level)) LogText(level, fmt::format(format, std::forward<Args>(args)...));
}

}  // namespace plumbline

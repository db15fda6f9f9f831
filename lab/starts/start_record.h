// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace plumbline {

// Result of an attempt to start a monocular map at a frame.
enum class StartOutcome {
  kRight,     // a map within all limits
  kLate,      // the same, after the time
  kWrong,     // a map beyond a limit, at any time
  kWaiting,   // no map
  kUnjudged,  // a map, but the true poses are unknown
};
constexpr auto EnumNames(std::type_identity<StartOutcome>) {
  return std::array{std::pair{StartOutcome::kRight, "right"},
                    std::pair{StartOutcome::kLate, "late"},
                    std::pair{StartOutcome::kWrong, "wrong"},
                    std::pair{StartOutcome::kWaiting, "waiting"},
                    std::pair{StartOutcome::kUnjudged, "unjudged"}};
}

// Errors of a map. nullopt: the truth is unknown.
struct StartErrors {
  std::optional<double> rotation_deg;   // of the newest view against the first
  std::optional<double> direction_deg;  // of the newest view's centre, seen from the first
  // Of the points with known true depth: |s / z_estimated - 1 / z_true| * z_true, median, and the
  // share of points for which it is above a fifth; s makes the median ratio 1. Infinite if most
  // points lie behind the camera.
  std::optional<double> depth;
  std::optional<double> depth_outliers;
  int compared = 0;  // points
};

// Map of a successful attempt.
struct StartMap {
  int frames = 0;                      // offered until then, the reference among them
  double seconds = 0;                  // of video until then
  int reference = 0, newest = 0;       // first and last view, frames of the sequence
  std::optional<double> parallax_deg;  // true parallax between these, median
  double estimated_parallax_deg = 0;   // as reported by the method
  int points = 0, lines = 0;
  StartErrors errors;
};

// One attempt.
struct StartRecord {
  int frame = 0;  // the first one offered
  StartOutcome outcome = StartOutcome::kWaiting;
  // Waiting: the reason at the last frame. Wrong: the exceeded limits, "rotation depth".
  std::string reason;
  int offered = 0;                              // frames
  std::optional<double> greatest_parallax_deg;  // true, to any frame in the time; nullopt: unknown
  std::optional<StartMap> map;
};

// The records as CSV, one a line under a line of names; unknown values are empty. The same records
// give the same bytes.
std::string FormatStarts(const std::vector<StartRecord>& records);

// Reads the output of FormatStarts. Throws InputError with file and line.
std::vector<StartRecord> ReadStarts(const std::filesystem::path& path);

}  // namespace plumbline

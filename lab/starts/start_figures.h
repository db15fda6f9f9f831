// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/starts/start_record.h"

#include <functional>
#include <map>
#include <span>
#include <string>

namespace plumbline {

// A start is possible if the true median parallax reaches this within the time.
inline constexpr double kPossibleParallaxDeg = 2;

// Returns true if a start can give a map; nullopt if the truth is unknown.
std::optional<bool> IsPossible(const StartRecord& record);

// Figures of a set of starts, by name. Unknown ones are left out, for example `success` without any
// possible start.
//
//   starts, possible, wrong          numbers; wrong among all starts
//   late                             possible ones with a right map after the time
//   waiting                          possible ones without a map
//   success, success_in_the_end      right ones of the possible, percent; and with late ones
//   wrong_rate, accepted             wrong ones, and those with a map, of all, percent
//   map_frames, map_seconds          until there is a map: median, and with _p95 95th percentile
//   map_parallax                     true median parallax of the maps, degrees, median
//   rotation_error, direction_error  degrees: median, and _p95
//   depth_error, depth_outliers      percent, the same (StartErrors)
//   map_points, map_lines            medians
//
// Those of maps are of all maps, wrong and late ones too.
std::map<std::string, double, std::less<>> FiguresOf(std::span<const StartRecord> records);

// Returns the value that `share` of the values do not exceed (nearest rank); they must not be
// empty.
double Percentile(std::vector<double> values, double share);

}  // namespace plumbline

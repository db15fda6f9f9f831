// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace plumbline {

// Returns the least number of steps that turn `a` into `b`. A step inserts, deletes or replaces a
// character, or swaps two neighbours (optimal string alignment: no part is edited twice).
std::size_t EditDistance(std::string_view a, std::string_view b);

// Returns the candidate of least edit distance to `name` (ties: the first); nullopt if all are too
// different. For dotted names a candidate whose last part is near also counts, so that `seed` finds
// `slam.seed`; if there is none, one of the nearest group does: `trackng.foo` finds a name that
// begins with `tracking.`.
std::optional<std::string> NearestName(std::string_view name,
                                       std::span<const std::string> candidates);

}  // namespace plumbline

// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace plumbline {

// Returns pairs of times from two ascending lists, by index, in order. Each time is the nearest to
// the other (the earlier of two equally near ones) and at most `most_ns` from it. O(n log n).
std::vector<std::pair<std::size_t, std::size_t>> PairByStamp(
    const std::vector<std::int64_t>& first,
    const std::vector<std::int64_t>& second,
    std::int64_t most_ns);

}  // namespace plumbline

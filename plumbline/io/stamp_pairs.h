// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace plumbline {

// Pairs of times from two ascending lists, by index, in order: each is the nearest to the other
// (the earlier of two equally near) and no more than `most_ns` from it. O(n log n).
std::vector<std::pair<std::size_t, std::size_t>> PairByStamp(
    const std::vector<std::int64_t>& first,
    const std::vector<std::int64_t>& second,
    std::int64_t most_ns);

}  // namespace plumbline

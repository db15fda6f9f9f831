// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace plumbline {

// Returns the n with which every n-th of `count` items are at most `limit`.
inline std::size_t StepFor(std::size_t count, std::size_t limit) {
  return std::max<std::size_t>(1, (count + limit - 1) / std::max<std::size_t>(limit, 1));
}

// Keeps the first of every `step` items.
template <class T>
void KeepEvery(std::size_t step, std::vector<T>& things) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < things.size(); i += step) things[kept++] = things[i];
  things.resize(kept);
}

}  // namespace plumbline

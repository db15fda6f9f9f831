// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

namespace plumbline {

// Returns the memory in bytes that a vector holds beside itself, its reserve included.
template <class T>
std::size_t HeapBytes(const std::vector<T>& items) {
  return items.capacity() * sizeof(T);
}

}  // namespace plumbline

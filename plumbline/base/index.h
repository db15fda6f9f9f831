// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace plumbline {

// Converts a number >= 0 to the index type of containers.
constexpr std::size_t Index(int i) { return static_cast<std::size_t>(i); }

}  // namespace plumbline

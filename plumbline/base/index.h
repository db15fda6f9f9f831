// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace plumbline {

// Turns a number that counts from 0 into the type of indices of containers.
constexpr std::size_t Index(int i) { return static_cast<std::size_t>(i); }

}  // namespace plumbline

// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace plumbline {

// Memory of the lines in local bundle adjustment, summed over all windows.
struct AdjustedLines {
  std::size_t count = 0;
  std::size_t bytes = 0;
};

}  // namespace plumbline

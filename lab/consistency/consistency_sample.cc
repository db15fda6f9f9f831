// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/consistency/consistency_sample.h"

#include "plumbline/base/error.h"

#include <array>
#include <cstddef>

namespace plumbline {

double Chi2Limit90(int dof) {
  constexpr std::array kLimits{2.7055, 4.6052, 6.2514, 7.7794, 9.2364, 10.6446};
  PLUMBLINE_CHECK(dof >= 1 && dof <= static_cast<int>(kLimits.size()), "one to six components");
  return kLimits[static_cast<std::size_t>(dof - 1)];
}

}  // namespace plumbline

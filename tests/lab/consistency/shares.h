// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/consistency/consistency_sample.h"

#include <vector>

namespace plumbline {

// Samples of a kind.
inline std::vector<ConsistencySample> OfKind(const std::vector<ConsistencySample>& samples,
                                             ConsistencyKind kind) {
  std::vector<ConsistencySample> found;
  for (const ConsistencySample& sample : samples) {
    if (sample.kind == kind) found.push_back(sample);
  }
  return found;
}

// Share of the samples of a kind that are inside; 0 without any.
inline double ShareInside(const std::vector<ConsistencySample>& samples, ConsistencyKind kind) {
  double inside = 0, all = 0;
  for (const ConsistencySample& sample : OfKind(samples, kind)) {
    ++all;
    if (IsInside(sample)) ++inside;
  }
  return all > 0 ? inside / all : 0;
}

}  // namespace plumbline

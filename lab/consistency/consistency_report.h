// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/consistency/consistency_sample.h"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace plumbline {

// How well the promised covariances of a class of errors hold.
struct ConsistencyShare {
  std::string kind;  // of ConsistencyKind
  std::string of;    // the class: "all", "length below 60 px"
  std::size_t samples = 0;
  double inside = 0;  // share within the 90 % interval
  // Factor for the promised deviations with which the median of the errors is as promised.
  double factor = 0;
};

// Returns the shares of each kind that has samples, as a whole and by class: length, contrast,
// distance from the image's middle, octave and age (earlier keyframes), as far as they apply.
std::vector<ConsistencyShare> ConsistencyShares(std::span<const ConsistencySample> samples);

// Returns the shares as a table; classes of fewer than `least` samples are left out.
std::string ConsistencyTable(std::span<const ConsistencyShare> shares, std::size_t least);

// Returns the shares as a JSON list of objects with the fields of ConsistencyShare.
std::string ConsistencyJson(std::span<const ConsistencyShare> shares);

}  // namespace plumbline

// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/parallel.h"
#include "plumbline/io/datasets/dataset.h"

#include <cstddef>
#include <optional>

namespace plumbline {

// Reads frames of a data set, and the one after in another thread while the caller works. What a
// call returns or throws is what Dataset::Read does for its frame, whatever was read ahead.
class ReadAhead {
 public:
  // The data set must outlive this object, whose destruction waits until nothing is read.
  explicit ReadAhead(const Dataset& dataset) : dataset_(dataset) {}

  // Returns frame i, and begins to read frame `next`, if there is one.
  Expected<SensorFrame, ImageFailure> Read(std::size_t i, std::optional<std::size_t> next);

 private:
  // The frame that was read ahead, of index `ahead_index_`; empty if reading threw.
  std::optional<Expected<SensorFrame, ImageFailure>> ahead_;
  std::size_t ahead_index_ = 0;
  bool asked_ = false;
  const Dataset& dataset_;
  HelperThread helper_;  // declared last: it ends before the members that it uses
};

}  // namespace plumbline

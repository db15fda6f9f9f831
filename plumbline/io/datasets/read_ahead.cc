// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/datasets/read_ahead.h"

#include <utility>

namespace plumbline {

Expected<SensorFrame, ImageFailure> ReadAhead::Read(std::size_t i,
                                                    std::optional<std::size_t> next) {
  if (asked_) helper_.Finish();
  std::optional<Expected<SensorFrame, ImageFailure>> read;
  if (asked_ && ahead_index_ == i) read = std::move(ahead_);
  asked_ = false;
  ahead_.reset();
  // What the thread had not begun, or could not do, is done here, where exceptions belong.
  if (!read) read.emplace(dataset_.Read(i));
  if (next) {
    ahead_index_ = *next;
    asked_ = helper_.Ask([this] {
      try {
        ahead_.emplace(dataset_.Read(ahead_index_));
      } catch (...) {  // the caller, who reads the frame again, gets the exception
        ahead_.reset();
      }
    });
  }
  return *std::move(read);
}

}  // namespace plumbline

// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/io/dataset.h"

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <thread>

namespace plumbline {

// Reads frames of a data set in a thread of its own, so that a disk or network that does not answer
// holds nobody up for ever.
class FrameReader {
 public:
  // Throws std::system_error when no thread can be started.
  explicit FrameReader(std::shared_ptr<const Dataset> dataset);
  FrameReader(const FrameReader&) = delete;
  FrameReader& operator=(const FrameReader&) = delete;
  // Does not wait for a reading that was given up: its thread stays behind until it ends.
  ~FrameReader();

  // Dataset::Read(frame). `go_on` is asked about every 50 ms while that takes; when it says no, the
  // reading has a quarter of a second more, then it is given up: nullopt, and nothing can be read
  // any more. Rethrows what Dataset::Read throws.
  std::optional<Expected<SensorFrame, ImageFailure>> Read(std::size_t frame,
                                                          const std::function<bool()>& go_on);

 private:
  struct Exchange;
  static void Work(const std::shared_ptr<Exchange>& exchange);

  std::shared_ptr<Exchange> exchange_;
  bool given_up_ = false;
  std::thread thread_;
};

}  // namespace plumbline

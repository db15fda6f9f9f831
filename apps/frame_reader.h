// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/io/dataset.h"

#include "apps/patient_reader.h"
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>

namespace plumbline {

// Reads frames of a data set in a thread of its own (patient_reader.h).
class FrameReader {
 public:
  // Throws std::system_error if no thread can be started.
  explicit FrameReader(const std::shared_ptr<const Dataset>& dataset)
      : reader_([dataset](std::size_t frame) { return dataset->Read(frame); }) {}

  // Returns Dataset::Read(frame); nullopt if the call was abandoned.
  std::optional<Expected<SensorFrame, ImageFailure>> Read(std::size_t frame,
                                                          const std::function<bool()>& go_on) {
    return reader_.Read(frame, go_on);
  }

 private:
  PatientReader<Expected<SensorFrame, ImageFailure>> reader_;
};

}  // namespace plumbline

// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/inertial/inertial_sample.h"
#include "plumbline/slam/run_result.h"

#include "apps/inertial_input.h"
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <pybind11/pybind11.h>

namespace plumbline::python {

// The inertial sensor of run().
class RunInertial {
 public:
  explicit RunInertial(InertialInput input)
      : input_(std::move(input)), feed_(input_.recording.get()) {}

  // Null: none is used.
  const InertialRecording* recording() const { return input_.recording.get(); }
  InertialFeed& feed() { return feed_; }
  // Returns the faults of the samples that are known before the run, or why they are left out.
  const std::vector<std::string>& notes() const { return input_.notes; }
  // Returns the faults of the sensor that a finished run, the same in all calls, has found.
  const std::vector<std::string>& NotesAfter(const RunResult& finished);

 private:
  InertialInput input_;
  InertialFeed feed_;
  std::optional<std::vector<std::string>> after_;
};

// Returns the samples of an array (N, 7): stamp in nanoseconds, rates in rad/s, forces in m/s^2;
// none of None. Throws InputError for another shape, NaN, infinity and values that no sensor
// measures (IsPlausible), and stamps that are none.
std::vector<InertialSample> ReadInertialSamples(pybind11::handle value);

}  // namespace plumbline::python

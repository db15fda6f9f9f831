// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/io/inertial/inertial_recording.h"
#include "plumbline/slam/run_result.h"

#include "apps/command_line.h"
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace plumbline {

// The inertial sensor of a run, as --imu chooses it.
struct InertialInput {
  std::shared_ptr<const InertialRecording> recording;  // null: none is used
  // One sentence each: why a sensor is left out, or what is wrong with the samples.
  std::vector<std::string> notes;
};

// Looks for the inertial sensor of a data set, unless --imu is off, the default. With `auto` a
// sensor that cannot be used is left out with a note: its samples are malformed or in units that
// cannot be, its place at the camera is not known, the images are turned. With a FILE all but the
// units are an InputError. A range that the samples show is noted in the calibration.
InertialInput OpenInertial(const CommandLine& line, const Dataset& dataset);

// Gives the samples of a recording out, frame by frame.
class InertialFeed {
 public:
  // recording  null: there are none; must outlive this object
  explicit InertialFeed(const InertialRecording* recording) : recording_(recording) {}
  // Returns the samples since the last call, up to those that a frame needs: 20 ms more than its
  // stamp, since the clocks may be apart by more than the calibration tells.
  std::span<const InertialSample> UpTo(std::int64_t stamp_ns);

 private:
  const InertialRecording* recording_;
  std::size_t next_ = 0;
};

// Compares rotation and clock of the calibration with the turns of the run's own trajectory.
// Returns one sentence for each number that is wrong, with what would be right, and one if the
// gyroscope was put aside for a while.
std::vector<std::string> InertialNotes(const RunResult& result, const InertialRecording& recording);

}  // namespace plumbline

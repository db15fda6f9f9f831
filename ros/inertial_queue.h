// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/inertial/inertial_calibration.h"
#include "plumbline/inertial/inertial_sample.h"
#include "plumbline/io/recordings/image_message.h"

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

namespace plumbline::ros_node {

// Returns the calibration of the inertial sensor that `imu` chooses, as `plumbline run --imu` does:
// off (nullopt), auto (of `camera`, nullopt where it is no file that tells the place of a sensor),
// or a file, completed by what `camera` tells. Throws InputError for files that are malformed, and
// for a file without the place of the sensor.
std::optional<InertialCalibration> FindInertialCalibration(const std::string& imu,
                                                           const std::string& camera);

// The measurement of a message; nullopt where it has no stamp, or no rates that can be.
std::optional<InertialSample> SampleOf(const InertialMessage& message);

// Keeps the samples of an inertial sensor until frames need them, and tells frames whether to wait
// for some that are on their way. Stamps of frames are the camera's as it sent them. A frame gets
// those up to 20 ms beyond its own stamp, as of a recording (InertialFeed).
class InertialQueue {
 public:
  // time_offset: of the calibration. patient: frames wait for all that they get, else only for
  // those up to their stamp.
  InertialQueue(double time_offset, bool patient);

  // Samples that are not later than the newest are left out, but that of a clock that was set back
  // by more than a second replaces those from before.
  void Add(const InertialSample& sample);

  // Whether a frame should wait: the sensor is alive (its newest sample is less than a second
  // older than the frame), has not come so far, and no frame is more than 0.1 s newer.
  bool MustWait(std::int64_t frame_ns, std::int64_t newest_frame_ns) const;

  // Takes out what a frame gets.
  std::vector<InertialSample> TakeUpTo(std::int64_t frame_ns);

 private:
  std::int64_t offset_ns_, awaited_ns_;  // the sensor's clock and what is awaited, from a frame's
  std::deque<InertialSample> samples_;
  std::optional<std::int64_t> newest_ns_;
};

}  // namespace plumbline::ros_node

// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/inertial/inertial_samples.h"
#include "plumbline/inertial/turning_stretch.h"
#include "plumbline/io/inertial/inertial_recording.h"
#include "plumbline/io/live/live_source.h"
#include "plumbline/slam/run_result.h"

#include "apps/command_line.h"
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace plumbline {

// Which inertial sensor a run is to use.
struct InertialRequest {
  bool used = false;
  bool required = false;  // one that cannot be used is an InputError
  bool asked = true;      // a note tells that there is none
  std::optional<std::string> file = std::nullopt;
  std::optional<std::string> camera = std::nullopt;
  std::vector<std::string> topics = {};
  Rotation rotation = Rotation::kAuto;
};

// Reads the request from --imu, --camera, --topic and --rotate. Without --imu the sensor that comes
// with the data is used, but by the systems of the papers (--preset).
InertialRequest ReadInertialRequest(const CommandLine& line);

// The inertial sensor of a run, as --imu chooses it.
struct InertialInput {
  std::shared_ptr<const InertialRecording> recording;  // null: none is used
  // One sentence each: why a sensor is left out, or what is wrong with the samples.
  std::vector<std::string> notes;
};

// Looks for the inertial sensor of a data set. One that cannot be used is left out with a note, or
// is an InputError if it is required: its samples are malformed, its place at the camera is not
// known, the images are turned. One in units that cannot be is left out. Faults of the first ten
// minutes of samples become notes; a range that they show is noted in the calibration.
InertialInput OpenInertial(const InertialRequest& request, const Dataset& dataset);

// Uses samples that a caller has, of the sensor that the files of the request, or a camera file
// with the data, tell about. Faults are dealt with as by OpenInertial.
InertialInput OpenGivenInertial(const InertialRequest& request,
                                const Dataset& dataset,
                                std::vector<InertialSample> samples);

// Uses the samples that a live source brings, which are not known yet.
InertialInput OpenLiveInertial(const InertialRequest& request, const LiveSource& source);

// Gives the samples of a sensor out, frame by frame, and reads them no sooner. What it holds does
// not grow with the length of the run.
class InertialFeed {
 public:
  // recording  null: there are none; must outlive this object
  explicit InertialFeed(const InertialRecording* recording);

  // Takes samples that came with the next frame of a live source.
  void Add(std::span<const InertialSample> samples);
  // Returns the samples since the last call, up to those that a frame needs: 20 ms more than its
  // stamp, since the clocks may be apart by more than the calibration tells. Of more than a minute
  // at 1 kHz the newest. Valid until the next call.
  std::span<const InertialSample> UpTo(std::int64_t stamp_ns);
  // Returns, after the last frame, those of the samples that tell most about the sensor. Reads half
  // a second more of them, as the clocks may be apart.
  std::span<const InertialSample> Telling();
  // Adds how many samples were left out so far as out of order.
  void CountInto(OrderedSamples& ordered) const { order_.CountInto(ordered); }
  // The samples of a sequence that could not be used so far.
  const UnusableSamples& unusable() const { return unusable_; }
  // Samples that are held.
  std::size_t held() const { return waiting_.size() + given_.size() + stretch_.held(); }

 private:
  std::optional<InertialSample> Next();
  void TakeOrdered();

  const InertialRecording* recording_;
  std::unique_ptr<InertialStream> stream_;  // null of a live source
  TimeOrder order_;
  std::deque<InertialSample> waiting_;  // for the next frame
  std::vector<InertialSample> given_;   // with the last frame
  std::int64_t last_ns_ = 0;            // stamp of the last frame
  TurningStretch stretch_;
  UnusableSamples unusable_;
};

// Compares rotation and clock of the calibration with the turns of the run's own trajectory.
// Returns one sentence for each number that is wrong, with what would be right, and one if the
// gyroscope was not used, with the reason, or put aside for a while, or samples were left out.
//
//   feed      after the last frame
//   unusable  those that were not told before the run
std::vector<std::string> InertialNotes(const RunResult& result,
                                       const InertialRecording& recording,
                                       InertialFeed& feed,
                                       const UnusableSamples& unusable);

}  // namespace plumbline

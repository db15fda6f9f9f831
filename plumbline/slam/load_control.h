// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/features/extractor.h"
#include "plumbline/mapping/options.h"
#include "plumbline/slam/load_level.h"

namespace plumbline {

// Delay of a live run at the turn of a frame.
struct Load {
  double wait = 0;         // waiting time since the frame arrived, in intervals between frames
  int frames_dropped = 0;  // frames left out since the last frame that was tracked
  int tasks_waiting = 0;   // tasks that mapping has not begun, most of them keyframes
};

// Decides from frame to frame how much work is shed. A frame is late if it waited longer than the
// time between two frames, or if a frame before it was left out. Several late frames in a row make
// the run shed the next value of LoadLevel as well; several frames in a row that hardly waited undo
// one step. If only mapping is behind, only mapping is shed. The decision depends only on the
// loads.
class LoadControl {
 public:
  // Late frames in a row until more is shed; one left-out frame is enough.
  static constexpr int kLateFrames = 2;
  static constexpr int kCalmFrames = 8;     // frames in a row that hardly waited until less is shed
  static constexpr double kLateWait = 1;    // wait that makes a frame late [intervals]
  static constexpr double kCalmWait = 0.5;  // wait below which a frame hardly waited [intervals]
  static constexpr int kManyTasksWaiting = 3;

  // Returns the level of shedding for the next frame, at most kPoints.
  LoadLevel Next(const Load& load);

 private:
  LoadLevel shed_ = LoadLevel::kNothing;  // level reached by late frames
  int late_ = 0;
  int calm_ = 0;
  bool mapping_ = false;  // true if mapping is behind
};

// Returns the share of the usual number of point features that is extracted.
double FeatureShare(LoadLevel shed);

// Returns options that extract fewer features, or map keyframes with less work, as `shed` says.
FeatureOptions ReducedOptions(FeatureOptions options, LoadLevel shed);
MappingOptions ReducedOptions(MappingOptions options, LoadLevel shed);

}  // namespace plumbline

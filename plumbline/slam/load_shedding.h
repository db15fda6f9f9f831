// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/features/extractor.h"
#include "plumbline/mapping/options.h"

#include <array>
#include <type_traits>
#include <utility>

namespace plumbline {

// What a live run leaves undone for a frame where the machine is too slow or too busy, in the order
// in which it does so: each includes what stands before it.
enum class Shed {
  kNothing,
  kMapping,  // mapping makes fewer landmarks and adjusts a smaller window
  kLines,    // fewer lines are measured
  kPoints,   // fewer points are measured
  kFrame     // the frame is left out
};
constexpr auto EnumNames(std::type_identity<Shed>) {
  return std::array{std::pair{Shed::kNothing, ""},
                    std::pair{Shed::kMapping, "mapping"},
                    std::pair{Shed::kLines, "lines"},
                    std::pair{Shed::kPoints, "points"},
                    std::pair{Shed::kFrame, "frame"}};
}

// How far behind a live run is when the turn of a frame comes.
struct Load {
  double wait = 0;            // since the frame's arrival, in intervals between frames
  int frames_dropped = 0;     // left out since the last frame that was tracked
  int keyframes_waiting = 0;  // for mapping, but for the one it is at
};

// Decides from frame to frame what is shed. A late frame is one that waited longer than the time
// between two, or before which one was left out. Each of several late frames in a row adds what
// comes next in the order, and several frames in a row that hardly waited give the last one back.
// Where only mapping is behind, only its work is less. A pure function of the loads handed to it.
class LoadShedding {
 public:
  static constexpr int kLateFrames = 2;     // in a row until more is shed; after a drop at once
  static constexpr int kCalmFrames = 8;     // in a row until less is shed
  static constexpr double kLateWait = 1;    // intervals
  static constexpr double kCalmWait = 0.5;  // intervals
  static constexpr int kManyKeyFramesWaiting = 3;

  // What to shed for the frame whose turn has come: kPoints at most.
  Shed Next(const Load& load);

 private:
  Shed shed_ = Shed::kNothing;  // because of frames
  int late_ = 0;
  int calm_ = 0;
  bool mapping_ = false;  // behind
};

// The share of the usual number of features that is measured.
double FeatureShare(Shed shed);

// What is measured and how keyframes are mapped where something is shed.
FeatureOptions Lightened(FeatureOptions options, Shed shed);
MappingOptions Lightened(MappingOptions options, Shed shed);

}  // namespace plumbline

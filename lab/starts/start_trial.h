// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/starts/start_errors.h"
#include "lab/starts/start_record.h"
#include "lab/starts/start_truth.h"
#include "plumbline/geometry/rectified_camera.h"
#include "plumbline/initialization/initializer.h"

#include <functional>
#include <optional>
#include <vector>

namespace plumbline {

// The frames of a sequence as input of an initializer; nullopt for an unreadable one. Ids are the
// numbers of the frames.
using StartFrames = std::function<std::optional<InitializationFrame>(int frame)>;

// Frames begin, ..., end - 1 are offered until there is a map. Those before `in_time` determine
// whether a start is possible; a map after them is late.
struct StartRange {
  int begin = 0, in_time = 0, end = 0;
};

// Data common to all starts of a sequence.
struct StartTask {
  const StartFrames& frames;
  const StartTruth& truth;
  RectifiedCamera camera;
  StartLimits limits;
  // Called with every map.
  std::function<void(const StartRecord&, const InitialMap&)> on_map = {};
};

// Tries to start a map at one frame, and compares the result with the truth.
//
// The newest view is compared with the first one of the map, which need not be the first frame
// offered. Unreadable frames are left out.
//
//   initializer    without frames
//   milliseconds   the time of each call of Add is appended
StartRecord TryStart(const StartRange& range,
                     const StartTask& task,
                     Initializer& initializer,
                     std::vector<double>& milliseconds);

}  // namespace plumbline

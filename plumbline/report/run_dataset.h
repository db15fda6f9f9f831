// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/stop_check.h"
#include "plumbline/io/datasets/dataset.h"
#include "plumbline/slam/frame_record.h"
#include "plumbline/slam/options.h"
#include "plumbline/slam/run_result.h"

#include <functional>

namespace plumbline {

// Receives the record of each frame, in the order of the frames, in the tracking thread.
using FrameObserver = std::function<void(const FrameRecord& record)>;

// Runs SLAM on a whole recorded sequence: the only call needed for trajectories and map.
//
//   dataset   result of OpenDataset
//   options   as for System. In live mode frames are delivered at the intervals of the recording,
//             in the other modes as soon as they are read.
//   observe   may be empty
//   stop      called before each frame; once true, no more frames are processed, and the final
//             adjustment of the maps is cut short. May be empty.
//   returns   trajectories, maps and lines (RunResult), which do not refer to the data set
//
// A frame whose image cannot be read, or has another size than the calibration, is skipped and
// recorded with ImageFailure::reason. Throws InputError for an invalid calibration. The result has
// the same bytes as that of the program's `run`, except in live mode. Cost: the time of the run. In
// lockstep mode a thread reads one image ahead.
RunResult RunDataset(const Dataset& dataset,
                     const SlamOptions& options = {},
                     const FrameObserver& observe = {},
                     const StopCheck& stop = {});

}  // namespace plumbline

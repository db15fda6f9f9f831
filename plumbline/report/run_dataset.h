// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/stop_check.h"
#include "plumbline/io/dataset.h"
#include "plumbline/slam/frame_record.h"
#include "plumbline/slam/options.h"
#include "plumbline/slam/system.h"

#include <functional>
#include <memory>

namespace plumbline {

// Takes the record of each frame, in the order of the frames, in the thread that tracks.
using FrameObserver = std::function<void(const FrameRecord& record)>;

// Tracks the camera through a whole recorded sequence and maps what it sees: the one call that a
// program needs which only wants the trajectories and the map.
//
//   dataset   what OpenDataset gives
//   options   as for System. In live mode frames are handed over as far apart in time as they were
//             recorded, in the other modes as soon as they are read.
//   observe   may be empty
//   stop      asked before each frame; once it says yes no more frames are taken, and the
//             adjustment of the maps at the end is cut short. May be empty.
//   returns   the finished system: FinalTrajectory, CausalTrajectory, LineMap and maps() of it are
//             complete. It does not refer to the data set.
//
// A frame whose image cannot be read is skipped, and its record says so (image_unreadable). Throws
// InputError for a calibration that cannot be used and for an image of another size than the
// calibration says. The result has the same bytes as that of the program's `run`, except in live
// mode. Cost: the time of the run; images are read in the calling thread.
std::unique_ptr<System> RunDataset(const Dataset& dataset,
                                   const SlamOptions& options = {},
                                   const FrameObserver& observe = {},
                                   const StopCheck& stop = {});

}  // namespace plumbline

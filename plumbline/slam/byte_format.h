// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/state_format.h"
#include "plumbline/mapping/byte_format.h"
#include "plumbline/slam/frame_log.h"
#include "plumbline/slam/mapping_stage.h"
#include "plumbline/slam/stage_clock.h"
#include "plumbline/slam/system.h"
#include "plumbline/tracking/byte_format.h"

namespace plumbline {

// Transfer (base/byte_format.h) of what a run keeps beside its maps and its tracker.

template <class Archive, Like<RelocalizationOutcome> T>
void Transfer(Archive& archive, T& outcome) {
  TransferAll(archive, outcome.found, outcome.snapshot);
}
template <class Archive, Like<StageTime> T>
void Transfer(Archive& archive, T& time) {
  TransferAll(archive, time.stage, time.milliseconds);
}
template <class Archive, Like<FrameRecord> T>
void Transfer(Archive& archive, T& r) {
  TransferAll(archive, r.id, r.stamp_ns, r.status, r.reason, r.map, r.reference, r.from_reference);
  TransferAll(archive, r.causal_world_from_camera, r.causal_covariance, r.counts, r.keyframe);
  TransferAll(archive, r.shed, r.demoted);
  Transfer(archive, r.times);
}
// Writes the log as a list of its records.
template <class Archive, Like<FrameLog> T>
void Transfer(Archive& archive, T& log) {
  const std::size_t count = TransferCount(archive, log.size());
  for (std::size_t i = 0; i < count; ++i) {
    FrameRecord record;
    if constexpr (!Archive::kReading) record = log[i];
    Transfer(archive, record);
    if constexpr (Archive::kReading) {
      if (!log.Takes(record)) FailState(archive, "frames out of order");
      log.Add(record);
    }
  }
}

}  // namespace plumbline

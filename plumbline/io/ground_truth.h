// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/io/dataset.h"
#include "plumbline/io/stamp_order.h"

#include <filesystem>
#include <vector>

namespace plumbline {

// The word of DatasetOptions::ground_truth that leaves the ground truth aside.
constexpr const char* kNoGroundTruth = "none";

// Where the ground truth of a data set is, and what it is about.
struct DeliveredTruth {
  std::vector<std::filesystem::path> files = {};  // the first one that exists is read; need not be
  GroundTruth::Frame frame = GroundTruth::Frame::kCamera;
  const std::vector<StampedRow>* times = nullptr;  // of the rows of KITTI poses
};

// Reads the ground truth of a data set into info.ground_truth: that of the file which the options
// name, else the delivered one, where there is any. Both are read in the formats of ReadTrajectory
// and are of the delivered frame; rows that cannot be used are left out and become notes
// (BadRows::kLeaveOut).
//
// A delivered file that cannot be used refuses nothing: its fault becomes info.ground_truth_fault.
// One that the options name was asked for: it throws the InputError. Poses of a body need
// info.calibration.body_from_left, which must have been read before.
void AddGroundTruth(const DeliveredTruth& delivered,
                    const DatasetOptions& options,
                    DatasetInfo& info);

}  // namespace plumbline

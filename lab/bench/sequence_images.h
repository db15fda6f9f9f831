// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/image/image.h"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace plumbline::bench {

struct Sequence {
  const char* name;
  const char* folder;
  const char* camera;  // null: found with the data
};

inline constexpr std::array kSequences{
    Sequence{"MH_01", "euroc/MH_01_easy_first250", nullptr},
    Sequence{"KITTI_06", "kitti/06_first51", nullptr},
    Sequence{"fr1_floor", "tum/rgbd_dataset_freiburg1_floor_first90", nullptr},
    Sequence{"ICL_office_kt3", "icl/office_kt3_first600", "icl_nuim"}};

struct SequenceImages {
  std::vector<GrayImage> left;  // rectified
  GrayImage mask;
};

// Returns `count` images spread over the sequence; nullopt if it is missing.
std::optional<SequenceImages> ReadImages(const std::string& data,
                                         const Sequence& sequence,
                                         int count);

// Returns the processor time of this thread so far.
double CpuMilliseconds();

}  // namespace plumbline::bench

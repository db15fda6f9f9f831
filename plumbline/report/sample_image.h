// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/segment.h"
#include "plumbline/slam/system.h"

#include <filesystem>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace plumbline {

// The rectified left image of one frame with its features.
struct SampleImage {
  FrameId frame;
  std::string file;           // name of the overlay image of the same frame
  int width = 0, height = 0;  // size of the image; positions are in its pixels
  std::string jpeg;           // the image, grey, reduced if it is very wide or high
  std::vector<Eigen::Vector2d> matched_points, other_points;
  std::vector<Segment2> matched_lines, other_lines;
};

// Makes the sample of the last processed frame. Cost: encoding the image, some milliseconds.
SampleImage MakeSampleImage(const FrameView& view, const std::string& file);

// Writes the rectified left image of the last frame as PNG with its features: matched points green,
// others grey; matched lines orange, others blue.
void WriteFeatureOverlay(const FrameView& view, const std::filesystem::path& path);

}  // namespace plumbline

// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/features/line_detection.h"
#include "plumbline/features/types.h"
#include "plumbline/image/image.h"

#include <vector>

namespace plumbline {

// Finds the straight lines of a whole image with their descriptors: DetectLines and DescribeLines
// on their common gradient. Equals the lines of a run for an image that needs no rectification.
//
//   image     pixels as delivered; lines are straight only if the lens has no distortion
//   count     largest number of lines: the best by length and contrast
//   returns   lines in pixels of `image`, directed with the bright side on the left; empty for an
//             empty image
//   cost      about 5 ms for 752x480 with the default detector
std::vector<LineFeature> FindLines(const GrayImage& image,
                                   int count = 200,
                                   LineDetector detector = LineDetector::kDrawing,
                                   const LineDetectionOptions& options = {});

}  // namespace plumbline

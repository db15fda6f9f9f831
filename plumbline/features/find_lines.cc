// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/features/find_lines.h"

#include "plumbline/features/lbd.h"
#include "plumbline/features/valid_region.h"
#include "plumbline/image/filters.h"

namespace plumbline {

std::vector<LineFeature> FindLines(const GrayImage& image,
                                   int count,
                                   LineDetector detector,
                                   const LineDetectionOptions& options) {
  if (image.empty()) return {};
  const GradientImage gradient = ComputeGradient(image, kLineBlurPx);
  const ValidRegion whole(image.width(), image.height());
  std::vector<LineFeature> lines = DetectLines(image, gradient, whole, detector, count, options);
  DescribeLines(gradient, &lines);
  return lines;
}

}  // namespace plumbline

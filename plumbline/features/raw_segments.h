// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/segment.h"
#include "plumbline/image/gradient.h"

#include <array>
#include <type_traits>
#include <utility>
#include <vector>

namespace plumbline {

enum class LineDetector { kDrawing, kLsd, kEdlines };

constexpr auto EnumNames(std::type_identity<LineDetector>) {
  return std::array{std::pair{LineDetector::kDrawing, "drawing"},
                    std::pair{LineDetector::kLsd, "lsd"},
                    std::pair{LineDetector::kEdlines, "edlines"}};
}

struct RawSegmentOptions {
  LineDetector detector = LineDetector::kDrawing;
  // Size of the image for detection, relative to `image`.
  double scale = 1;
  double min_length = 15;  // least length in pixels of `image`
  // Least mean gradient across the line, grey levels per pixel.
  double min_contrast = 3;
};

// Detects straight edges of an image, unrefined, in pixels of `image` and in any direction: by
// drawing (segment_drawing.h), LSD (Grompone von Gioi et al., PAMI 2010) or EDLines (Akinlar and
// Topal 2011), in the image itself or in a smaller one. `gradient` is that of the image after a
// blur of about 1 px.
std::vector<Segment2> FindRawSegments(const GrayImage& image,
                                      const GradientImage& gradient,
                                      const RawSegmentOptions& options);

}  // namespace plumbline

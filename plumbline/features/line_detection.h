// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/options.h"
#include "plumbline/features/types.h"
#include "plumbline/features/valid_region.h"
#include "plumbline/geometry/segment.h"
#include "plumbline/image/filters.h"

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

// Blur before the gradient for detecting, refining and describing lines [px].
inline constexpr double kLineBlurPx = 1;

// Least deviation of an end point across the line [px]: no line, however well it is fitted, may
// outweigh all others.
inline constexpr double kLeastLineSigmaPx = 0.2;

struct LineDetectionOptions {
  // Size of the image for detection, relative to the full image.
  double detection_scale = 1;
  // Least length of a segment, relative to the longer side of the image.
  double min_length = 0.035;
  bool merge = true;  // true: collinear neighbours are joined
  // True: segments are moved to the sub-pixel peak of the gradient.
  bool refine = true;
};

// Detects straight edges of an image, directed with the bright side on the left (see LineFeature),
// without descriptors: at most `count`, the best by length and contrast, spread over the image.
//
// Segments come from the detector (FindRawSegments). Collinear pieces of the same contrast sign are
// joined over small gaps. Each segment is refitted robustly to the sub-pixel maxima of the
// directional gradient across it. sigma_px is the deviation of an end point in that fit, but at
// least kLeastLineSigmaPx. Parts closer than 3 px to invalid pixels are cut off. `gradient` is that
// of `image` after a blur by kLineBlurPx. Deterministic. Cost: about 3 ms for 752x480 with the
// drawing detector.
std::vector<LineFeature> DetectLines(const GrayImage& image,
                                     const GradientImage& gradient,
                                     const ValidRegion& valid,
                                     LineDetector detector,
                                     int count,
                                     const LineDetectionOptions& options);

template <class Visitor>
void VisitFields(Visitor&& visit, LineDetectionOptions& o) {
  visit("detection_scale",
        o.detection_scale,
        "size at which segments are looked for, relative to the image",
        Range{0.1, 2});
  visit("min_length",
        o.min_length,
        "shortest segment relative to the longer side of the image",
        Range{0.005, 0.5});
  visit("merge", o.merge, "join collinear pieces");
  visit("refine", o.refine, "refine segments below the pixel");
}
// Returns the options of 0.2.0 that are constants now, with their values.
std::vector<RemovedOption> RemovedOptions(std::type_identity<LineDetectionOptions>);

}  // namespace plumbline

// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/options.h"
#include "plumbline/features/types.h"
#include "plumbline/features/valid_region.h"
#include "plumbline/image/gradient.h"

#include <array>
#include <type_traits>
#include <utility>
#include <vector>

namespace plumbline {

enum class LineDetector { kLsd, kEdlines };

constexpr auto EnumNames(std::type_identity<LineDetector>) {
  return std::array{std::pair{LineDetector::kLsd, "lsd"},
                    std::pair{LineDetector::kEdlines, "edlines"}};
}

struct LineDetectionOptions {
  double lsd_scale = 0.5;     // size at which LSD looks, relative to the image
  double min_length = 0.035;  // of a segment, relative to the longer side of the image
  bool merge = true;          // join collinear neighbours
  double merge_angle_deg = 1.5;
  double merge_offset_px = 1.2;  // across
  double merge_gap = 0.15;       // gap between two pieces relative to the shorter one
  bool refine = true;            // move segments to the sub-pixel peak of the gradient
  double min_contrast = 4;       // mean gradient across the line, grey levels per pixel
  double min_sigma_px = 0.5;     // floor of the deviation of an end point across the line
};

// Straight edges of an image, directed with the bright side on the left (see LineFeature), without
// descriptors; at most `count`, longest and strongest first choice but spread over the image.
//
// Segments by LSD (Grompone von Gioi et al., PAMI 2010) or EDLines (Akinlar and Topal 2011).
// Collinear pieces of like contrast sign are joined over small gaps. Each segment is then fitted
// again, robustly, to the sub-pixel maxima of the directional gradient across it; sigma_px is what
// that fit gives for an end point, not below min_sigma_px. Parts closer than 3 px to invalid pixels
// are cut off. `gradient` must belong to `image`. Deterministic. Cost: 9-12 ms for 752x480, nearly
// all in LSD.
std::vector<LineFeature> DetectLines(const GrayImage& image,
                                     const GradientImage& gradient,
                                     const ValidRegion& valid,
                                     LineDetector detector,
                                     int count,
                                     const LineDetectionOptions& options);

// Mean over the segment of the gradient component along the image normal (-dy, dx) of LineThrough,
// in grey levels per pixel: negative when the bright side is on the left.
double MeanNormalGradient(const GradientImage& gradient, const Segment2& segment);

template <class Visitor>
void VisitFields(Visitor&& visit, LineDetectionOptions& o) {
  visit("lsd_scale", o.lsd_scale, "size at which LSD looks, relative to the image", Range{0.1, 2});
  visit("min_length",
        o.min_length,
        "shortest segment relative to the longer side of the image",
        Range{0.005, 0.5});
  visit("merge", o.merge, "join collinear pieces");
  visit("merge_angle_deg",
        o.merge_angle_deg,
        "largest angle between joined pieces [deg]",
        Range{0, 10});
  visit("merge_offset_px",
        o.merge_offset_px,
        "largest offset across of joined pieces [px]",
        Range{0, 10});
  visit("merge_gap", o.merge_gap, "largest gap relative to the shorter piece", Range{0, 5});
  visit("refine", o.refine, "refine segments below the pixel");
  visit("min_contrast", o.min_contrast, "smallest mean gradient [grey levels/px]", Range{0, 255});
  visit("min_sigma_px",
        o.min_sigma_px,
        "floor of the deviation of an end point [px]",
        Range{0.01, 10});
}

}  // namespace plumbline

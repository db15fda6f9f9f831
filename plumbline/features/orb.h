// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/options.h"
#include "plumbline/features/types.h"
#include "plumbline/features/valid_region.h"
#include "plumbline/image/pyramid.h"

#include <array>
#include <optional>
#include <type_traits>
#include <vector>

namespace plumbline {

// Contrast above which corners are always found [grey levels]. Weaker ones are found only in cells
// without such a corner.
inline constexpr int kCornerContrast = 20;

// Standard deviation of a sharp corner at octave 0 [px]. This and the next are twice the scatter
// measured under true poses (docs/methods/disparities.md).
inline constexpr double kCornerSigmaPx = 0.2;
// Standard deviation added by noise to a corner with a contrast of one grey level [px]; inversely
// proportional to the contrast.
inline constexpr double kCornerNoiseSigmaPx = 6.7;

struct OrbOptions {
  double scale_factor = 1.2;
  // FAST threshold in cells without a corner of kCornerContrast, grey levels.
  int fast_min_threshold = 4;
  // Standard deviation of every corner due to errors of lens calibration and shutter, relative to
  // the width of the image.
  double calibration_sigma = 5e-4;
};

// Finds corners with binary descriptors, spread evenly over the image and the pyramid levels.
//
// FAST corners (Rosten and Drummond 2006) are found on each level, with a lower threshold in cells
// without any. Each level keeps a share of `count` in proportion to its width; corners are taken in
// turns from a grid, so that no textured region takes all. Orientation is by the intensity
// centroid, the descriptor is the steered BRIEF pattern of ORB (Rublee et al., ICCV 2011), 256
// bits. A corner moves to the peak of the Harris response (parabola, at most 1.5 level pixels).
// This more than halves the scatter between frames: from 0.45 to 0.2 level pixels on EuRoC; the
// Förstner point gives 0.50.
//
// The scatter grows with falling contrast. Matched under true poses and depths, corners move by 0.1
// level pixels from frame to frame above 100 grey levels, by 0.15 at 40, by 0.3 at 17 and by 1
// below 7, roughly hypot(0.1, 4 / contrast). The standard deviations are nearly in this proportion.
//
// `pyramid` must have been built with the factor of the options (BuildOrbPyramid). Corners closer
// to an invalid pixel or to the border than the patch (20 level pixels) are dropped. Positions and
// sigmas (of corner and noise * scale of the octave, and of the calibration) are in pixels of the
// full image. The result is ordered by octave, then as selected. Cost: about 4 ms for 752x480 and
// 1000 points.
std::vector<PointFeature> ExtractOrb(const ImagePyramid& pyramid,
                                     const ValidRegion& valid,
                                     int count,
                                     const OrbOptions& options);

// Returns the descriptors of this image at the positions, octaves and orientations of the given
// corners, which may come from another image, to compare the two images there. nullopt if the
// pyramid has no such octave, or if a descriptor would reach beyond the border.
std::vector<std::optional<Descriptor>> DescribeOrbAt(const ImagePyramid& pyramid,
                                                     const std::vector<PointFeature>& corners);

ImagePyramid BuildOrbPyramid(const GrayImage& image, const OrbOptions& options);

template <class Visitor>
void VisitFields(Visitor&& visit, OrbOptions& o) {
  visit("scale_factor", o.scale_factor, "size ratio of successive levels", Range{1.05, 2});
  visit("fast_min_threshold",
        o.fast_min_threshold,
        "contrast of a corner where there is none of 20 [grey levels]",
        Range{1, 255});
  visit(
      "calibration_sigma",
      o.calibration_sigma,
      "deviation that the calibration of the camera adds to every corner, relative to the width of "
      "the image",
      Range{0, 0.01});
}
// Returns the options of 0.2.0 that are constants now, with their values.
std::vector<RemovedOption> RemovedOptions(std::type_identity<OrbOptions>);

}  // namespace plumbline

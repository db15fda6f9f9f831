// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/options.h"
#include "plumbline/features/types.h"
#include "plumbline/features/valid_region.h"
#include "plumbline/image/pyramid.h"

#include <array>
#include <type_traits>
#include <vector>

namespace plumbline {

// Contrast of a corner [grey levels] that is found wherever it is; weaker ones where there is no
// such.
inline constexpr int kCornerContrast = 20;

struct OrbOptions {
  double scale_factor = 1.2;
  int fast_min_threshold = 4;  // grey levels, in cells without a corner of kCornerContrast
  double sigma_px = 0.2;       // of a sharp corner at octave 0
  // What noise adds: of a corner of one grey level of contrast, less as the contrast grows.
  double noise_sigma_px = 6.7;
  // What lenses and shutter that are not quite as the calibration says add to every corner,
  // relative to the width of the image.
  double calibration_sigma = 5e-4;
};

// Corners with binary descriptors, spread evenly over the image and the levels of its pyramid.
//
// FAST corners (Rosten and Drummond 2006) on each level, with a lower threshold in cells that have
// none; each level keeps a share of `count` that falls with its width, taken in turns from a grid
// so that no textured spot takes all. Orientation by the intensity centroid and the steered BRIEF
// pattern of ORB (Rublee et al., ICCV 2011), 256 bits. A corner moves to the
// peak of the Harris response (parabola, at most 1.5 level pixels), which more than halves the
// scatter between frames: 0.45 to 0.2 level pixels on EuRoC, where the Förstner point gives 0.50.
//
// The scatter grows as the contrast falls: matched under true poses and depths, corners move by
// 0.1 level pixels from frame to frame above 100 grey levels, 0.15 at 40, 0.3 at 17 and 1 below 7,
// roughly hypot(0.1, 4 / contrast). The deviations are nearly in this proportion.
//
// `pyramid` must have been built with the factor of the options (BuildOrbPyramid).
// Corners closer to an invalid pixel or to the border than the patch (20 level pixels) are left
// out. Result: position and sigma (of corner and noise * scale of the octave, and the
// calibration's) in pixels of the full image, ordered by octave, then as selected. Cost: about 4 ms
// for 752x480 and 1000 points.
std::vector<PointFeature> ExtractOrb(const ImagePyramid& pyramid,
                                     const ValidRegion& valid,
                                     int count,
                                     const OrbOptions& options);

ImagePyramid BuildOrbPyramid(const GrayImage& image, const OrbOptions& options);

template <class Visitor>
void VisitFields(Visitor&& visit, OrbOptions& o) {
  visit("scale_factor", o.scale_factor, "size ratio of successive levels", Range{1.05, 2});
  visit("fast_min_threshold",
        o.fast_min_threshold,
        "contrast of a corner where there is none of 20 [grey levels]",
        Range{1, 255});
  visit("sigma_px", o.sigma_px, "deviation of a sharp corner at octave 0 [px]", Range{0.05, 10});
  visit("noise_sigma_px",
        o.noise_sigma_px,
        "deviation that noise adds to a corner [px] times its contrast [grey levels]",
        Range{0, 100});
  visit(
      "calibration_sigma",
      o.calibration_sigma,
      "deviation that the calibration of the camera adds to every corner, relative to the width of "
      "the image",
      Range{0, 0.01});
}

constexpr auto FixedOptions(std::type_identity<OrbOptions>) {
  return std::array{FixedOption{"levels", "8"},
                    FixedOption{"fast_threshold", "20"},
                    FixedOption{"cell_px", "35"},
                    FixedOption{"subpixel", "true"}};
}

}  // namespace plumbline

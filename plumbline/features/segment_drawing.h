// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/segment.h"
#include "plumbline/image/filters.h"

#include <vector>

namespace plumbline {

// Finds straight edges, directed with the bright side on the left, by drawing them pixel by pixel.
//
// Anchors are local maxima of the gradient on every sixth row and column (denser for short
// segments), taken with the strongest first. From an anchor the edge is followed both ways, one
// column (row, for steep edges) at a time. The next edge point is the sub-pixel maximum of the
// gradient across the line, next to the prediction of the line fitted to the points so far. Points
// whose gradient is turned by more than 22.5 degrees, or that belong to an edge drawn before, count
// as missed. The walk ends if more than a quarter of the points or more than 8 are missed, or if
// the edge bends. Fitting while drawing, with jumps over gaps, follows ELSED (Suarez et al.,
// Pattern Recognition 127, 2022), edge drawing follows Topal and Akinlar (2012). Searching along
// the predicted line instead of from pixel to pixel is ours: docs/methods/line-front-end.md.
//
// `gradient` should be that of a smoothed image (sigma about 1). Cost: about 1 ms for 752x480.
//
//   min_length    in pixels of this image
//   min_gradient  least gradient across the line, at each of its pixels; grey levels per pixel
std::vector<Segment2> DrawSegments(const GradientImage& gradient,
                                   double min_length,
                                   double min_gradient);

}  // namespace plumbline

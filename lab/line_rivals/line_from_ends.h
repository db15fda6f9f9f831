// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/matching/line_from_views.h"

#include <optional>
#include <vector>

namespace plumbline {

// Makes a line of two keyframes as in EPL-SLAM: each end is a point visible in both, the start of
// one segment matched with the start of the other (also in right images, if it is visible there),
// and the line goes through both points. Segments that end at different points thus give a wrong
// line.
//
// An end must be in front of the cameras, with at least 1.15 degrees between its rays, as for a
// point of ORB-SLAM; along the line it may miss the measured ends, but not deviate from any
// measured line: chi2 of the two projected ends is at most 5.99 in every image. Returns nullopt
// otherwise, and for more than two keyframes. Neither id nor creator are set.
std::optional<MapLine> LineFromTwoEnds(const Map& map,
                                       const RectifiedCamera& camera,
                                       const std::vector<LineViewOf>& views);

}  // namespace plumbline

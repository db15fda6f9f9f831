// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/association/line_options.h"
#include "plumbline/association/projection_search.h"
#include "plumbline/base/stop_check.h"
#include "plumbline/map/map.h"
#include "plumbline/mapping/correction.h"
#include "plumbline/mapping/lens_calibration.h"
#include "plumbline/mapping/options.h"

#include <optional>

namespace plumbline {

// All keyframes and points of a finished map adjusted together with lines that four keyframes or
// more show (FindWellSeenLines, whatever mapping.line_map asks of those given out): each of these
// is one landmark with all segments that show it, where tracking had several that end where its
// search ended. This ties keyframes together that share no line landmark. Lines have the
// residual of eq. 13 here, whatever lines.residual says, and are not held parallel. The first
// keyframe stays where it is, and so do those that the points and well seen lines do not fix to
// mapping.window.max_pose_sigma, and both of two that follow each other and would be moved against
// one another by more than that (SolveInOnePiece); with a single camera the depth of
// what the first keyframe shows is kept, in the median, and each keyframe gets the scale by which
// the depths it shows have changed (KeyFrame::unit).
//
// With a single camera what the calibration has left of the lens's radial distortion is learned
// from the points and taken out of all measurements first (LearnLens, mapping.lens_calibration).
// `lens` is what an earlier adjustment of this map has learned, and is taken as it is; where there
// is none, it is learned and kept there.
//
// Nothing for a map of less than three keyframes, or one whose equations take longer than those of
// mapping.final_adjustment_keyframes that all share landmarks (FullSize), without the lines if
// those make it so; nothing when `stop` says so before the end. Cost: FindWellSeenLines, and bundle
// adjustment of the whole map, with the time of SchurSolver::Solve.
Correction AdjustWholeMap(const Map& map,
                          const ImagingModel& imaging,
                          const LineOptions& lines,
                          const MappingOptions& options,
                          std::optional<LensCorrection>& lens,
                          const StopCheck& stop = {});
// Adjusts the whole of a map as above, where no earlier adjustment has learned the lens; the lens
// that this one learns is given up with its end.
Correction AdjustWholeMap(const Map& map,
                          const ImagingModel& imaging,
                          const LineOptions& lines,
                          const MappingOptions& options,
                          const StopCheck& stop = {});

}  // namespace plumbline

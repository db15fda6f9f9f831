// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/stop_check.h"
#include "plumbline/map/map.h"
#include "plumbline/mapping/map_correction.h"
#include "plumbline/mapping/mapping_step.h"
#include "plumbline/mapping/options.h"
#include "plumbline/matching/line_method.h"
#include "plumbline/matching/projection_search.h"

#include <functional>
#include <vector>

namespace plumbline {

// Progress that AdjustWholeMap tells its caller.
struct AdjustmentProgress {
  std::vector<MappingStep> times = {};  // times of its steps, named as those of LocalMapper::Finish
  // Called with a new lens when keyframes and points are adjusted to it. The caller may then
  // correct the features of the map itself, so that the copy with the lens shares them; if the
  // adjustment ends without a correction, it has to take that back.
  std::function<void(const LensCorrection&)> on_lens = {};
};

// Returns true if AdjustWholeMap adjusts this map, as far as that is known beforehand: that it is
// neither too small nor too large for mapping.final_adjustment_keyframes. False when stopped. Cost:
// of maps of more keyframes than that, the problem of its points.
bool IsAdjustedAsAWhole(const Map& map,
                        const CameraAndPyramid& imaging,
                        const LineWeights& weights,
                        const MappingOptions& options,
                        const StopCheck& stop = {});

// Adjusts all keyframes and points of a map, when it is finished (LocalMapper::Finish) or beside
// mapping after a loop or a join (BackgroundAdjustment), together with lines that four keyframes or
// more show (FindWellSeenLines, with limits of its own instead of those in mapping.line_map). Each
// of these lines is one landmark with all of its segments, even if tracking made several at the
// limits of its search. Such lines constrain keyframes that share no line landmark. Lines have the
// residual of eq. 13 here, independent of lines.residual, and no parallelism.
//
// Some keyframes are fixed: the first one, those that the points and well observed lines do not
// determine to LocalBaWindowOptions::max_pose_sigma, and both of two consecutive keyframes that
// would move relative to one another by more than that (SolveWithPoseLimits). With a single camera
// the median depth of the first keyframe's landmarks is kept, and each keyframe is scaled by the
// change of the depths of its landmarks (KeyFrame::scale).
//
// With a single camera, the remaining radial distortion of the lens is first estimated from the
// points and removed from all measurements (CalibrateRadialDistortion, mapping.lens_calibration).
// It becomes part of the correction, in addition to the correction of the map's features. If the
// features are corrected for a lens, keyframes and points are adjusted to it without lines first,
// and lines are searched among the keyframes at their new poses. Lines of the map before would hold
// keyframes where a wrong lens had put them.
//
// Returns an empty correction for a map of less than three keyframes, and for one whose equations
// take longer to solve than those of mapping.final_adjustment_keyframes keyframes that all share
// landmarks (FullSize); if only the lines make it so large, it is adjusted without them. The
// correction is also empty when stopped. Cost: FindWellSeenLines, and bundle adjustment of the
// whole map, with the time of SchurSolver::Solve.
MapCorrection AdjustWholeMap(const Map& map,
                             const CameraAndPyramid& imaging,
                             const LineSettings& lines,
                             const MappingOptions& options,
                             const StopCheck& stop = {},
                             AdjustmentProgress* progress = nullptr);

// Estimates the lens of a single camera from the points of a growing map
// (CalibrateRadialDistortion), and adjusts keyframes and points to it. The newest keyframe that
// points determine keeps its pose and scale, so that tracking continues without a step. Keyframes
// that points do not determine to LocalBaWindowOptions::max_pose_sigma are not in the correction,
// so that they move with their parents. Lines move with the keyframes that show them.
//
// Returns an empty correction without a change of the lens, and when stopped. Cost:
// CalibrateRadialDistortion, and after a change one more adjustment of the points.
MapCorrection AdjustToLens(const Map& map,
                           const CameraAndPyramid& imaging,
                           const LineWeights& weights,
                           const MappingOptions& options,
                           const StopCheck& stop = {});

// Adjusts a map of a single camera to a lens known from another map, as AdjustToLens does for an
// estimated one. Returns an empty correction if the map has that lens already. Cost: an adjustment
// of the points.
MapCorrection BringToLens(const Map& map,
                          const CameraAndPyramid& imaging,
                          const LineWeights& weights,
                          const MappingOptions& options,
                          const LensCorrection& lens,
                          const StopCheck& stop = {});

}  // namespace plumbline

// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/stop_check.h"
#include "plumbline/map/map.h"
#include "plumbline/mapping/map_correction.h"
#include "plumbline/mapping/options.h"
#include "plumbline/matching/line_options.h"
#include "plumbline/matching/projection_search.h"

namespace plumbline {

// Adjusts all keyframes and points of a map, when nothing more will be added to it
// (LocalMapper::Finish) or beside mapping after a loop or a join (BackgroundAdjustment), together
// with lines that four keyframes or more show (FindWellSeenLines, with limits of its own instead of
// those in mapping.line_map). Each of these lines is one landmark with all segments that show it,
// where tracking made several that end where its search ended. Such lines tie keyframes together
// that share no line landmark. Lines have the residual of eq. 13 here, whatever lines.residual
// says, and are not held parallel.
//
// Some keyframes stay where they are: the first one, those that the points and well seen lines do
// not fix to mapping.window.max_pose_sigma, and both of two consecutive keyframes that would move
// against one another by more than that (SolveWithPoseLimits). With a single camera the depth of
// what the first keyframe shows is kept, in the median, and each keyframe gets the scale by which
// the depths it shows have changed (KeyFrame::scale).
//
// With a single camera, the radial distortion of the lens that the calibration has left is learned
// from the points first and taken out of all measurements (CalibrateRadialDistortion,
// mapping.lens_calibration). It becomes part of the correction, beside what the map's features are
// corrected by already. Where the features are corrected for a lens, points are adjusted without
// lines first.
//
// Returns an empty correction for a map of less than three keyframes, and for one whose equations
// take longer to solve than those of mapping.final_adjustment_keyframes keyframes that all share
// landmarks (FullSize); if only the lines make it so large, it is adjusted without them. The
// correction is also empty when `stop` says so before the end. Cost: FindWellSeenLines, and bundle
// adjustment of the whole map, with the time of SchurSolver::Solve.
MapCorrection AdjustWholeMap(const Map& map,
                             const CameraAndPyramid& imaging,
                             const LineOptions& lines,
                             const MappingOptions& options,
                             const StopCheck& stop = {});

// Learns the lens of a single camera from the points of a map that will still grow
// (CalibrateRadialDistortion), and adjusts keyframes and points to it. The newest keyframe that
// points fix stays where it is, with the lengths around it, so that tracking goes on without a
// step. Keyframes that points do not fix to mapping.window.max_pose_sigma are not in the
// correction, so that they move with their parents. Lines move with the keyframes that show them.
//
// Returns an empty correction where nothing is learned, and when `stop` says so before the end.
// Cost: CalibrateRadialDistortion, and one more adjustment of the points where something is
// learned.
MapCorrection AdjustToLens(const Map& map,
                           const CameraAndPyramid& imaging,
                           const LineWeights& weights,
                           const MappingOptions& options,
                           const StopCheck& stop = {});

// Adjusts a map of a single camera to a lens that is known from another map, as AdjustToLens does
// to one that it learns. Returns an empty correction where the map has that lens. Cost: an
// adjustment of the points.
MapCorrection BringToLens(const Map& map,
                          const CameraAndPyramid& imaging,
                          const LineWeights& weights,
                          const MappingOptions& options,
                          const LensCorrection& lens,
                          const StopCheck& stop = {});

}  // namespace plumbline

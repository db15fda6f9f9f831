// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/options.h"
#include "plumbline/solvers/relative_pose.h"

#include <array>
#include <string>
#include <type_traits>
#include <utility>

namespace plumbline {

// Matching of points in the frames after the reference.
enum class InitialMatching { kImages, kDescriptors };
constexpr auto EnumNames(std::type_identity<InitialMatching>) {
  return std::array{std::pair{InitialMatching::kImages, "images"},
                    std::pair{InitialMatching::kDescriptors, "descriptors"}};
}

// Treatment of points missing in some of the frames.
enum class MissingPlaces {
  kInterpolate,  // their positions are interpolated (first paper, section 2.2)
  kLeaveOut,     // the missing entries of the matrix have no weight
  kTriangulate,  // they are not factorized, but triangulated from the resulting poses
};
constexpr auto EnumNames(std::type_identity<MissingPlaces>) {
  return std::array{std::pair{MissingPlaces::kInterpolate, "interpolate"},
                    std::pair{MissingPlaces::kLeaveOut, "leave_out"},
                    std::pair{MissingPlaces::kTriangulate, "triangulate"}};
}

// Settings of the first paper's own start, rank1_pairwise.
struct PairwiseOptions {
  MissingPlaces missing = MissingPlaces::kInterpolate;
  bool reject_outliers = true;
  bool adjust = true;
};

template <class Visitor>
void VisitFields(Visitor&& visit, PairwiseOptions& o) {
  visit("missing",
        o.missing,
        "points that some frames do not show: interpolate (as the paper), leave_out (of the "
        "matrix), triangulate (from the poses found)");
  visit("reject_outliers",
        o.reject_outliers,
        "matches far from their epipolar lines are left out before anything is completed");
  visit("adjust",
        o.adjust,
        "a bundle adjustment of all frames makes the map; false: the poses of the factorization "
        "stay as they are");
}

struct InitializationOptions {
  std::string method = "rank1";
  // Frames after the reference that are solved together: m of the first paper.
  int frames = 3;
  RelativePoseMethod relative_pose = RelativePoseMethod::kFivePoint;
  bool factorize = true;
  bool interpolate = true;
  double min_line_angle_deg = 0;
  int reweighting = 5;
  InitialMatching matching = InitialMatching::kImages;
  PairwiseOptions pairwise = {};
};

template <class Visitor>
void VisitFields(Visitor&& visit, InitializationOptions& o) {
  visit("method",
        o.method,
        "of a monocular start: rank1 (factorization of several frames, completed by geometric "
        "interpolation), rank1_pairwise (the same as the first paper has it: each frame's pose by "
        "itself, and a start at once)",
        Methods{{"rank1", "rank1_pairwise"}});
  visit("frames", o.frames, "frames after the reference that are solved together", Range{2, 30});
  visit("relative_pose",
        o.relative_pose,
        "of rank1: five_point (and homographies), eight_point (as the paper; fails on planes)");
  visit("factorize",
        o.factorize,
        "rank1: solve for cameras and points by factorization; false: points from the first and "
        "the newest frame, poses of the frames between from these, all points from all poses; "
        "rank1_pairwise: false: translations get their lengths from frame to frame");
  visit("interpolate",
        o.interpolate,
        "rank1: complete tracks by geometric interpolation; false: factorize complete tracks only");
  visit("min_line_angle_deg",
        o.min_line_angle_deg,
        "smallest angle at which the epipolar lines of an interpolated place meet (the paper: 5) "
        "[deg]",
        Range{0, 90});
  visit("reweighting",
        o.reweighting,
        "steps of robust reweighting of the factorization; 0: outliers count in full",
        Range{0, 100});
  visit("matching",
        o.matching,
        "rank1: of points with the reference: images (followed, and shifted until the image looks "
        "as in the reference), descriptors (as the paper)");
  visit("pairwise", o.pairwise, "of rank1_pairwise: controls of what the first paper proposes");
}

}  // namespace plumbline

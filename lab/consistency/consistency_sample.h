// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/se3.h"
#include "plumbline/map/map.h"

#include <array>
#include <map>
#include <type_traits>
#include <utility>

#include <Eigen/Core>

namespace plumbline {

// The kinds of errors that are held against their covariance.
enum class ConsistencyKind {
  kPoint,          // a corner, against the landmark of its earlier observations
  kDisparity,      // its disparity, the same
  kLine,           // a segment of the left image, against the landmark of its earlier observations
  kRightLine,      // a segment of the right image, the same
  kSegment,        // a segment of the left image against the true line
  kRightSegment,   // a segment of the right image against the true line
  kPointLandmark,  // a triangulated point against the nearest surface
  kLineLandmark,   // a triangulated line against the nearest true line
  kCausal1s,       // the motion over 1 s of the poses as first reported
  kCausal5s,       // over 5 s
  kFinal1s,        // over 1 s of the final poses
  kFinal5s,        // over 5 s
};
constexpr auto EnumNames(std::type_identity<ConsistencyKind> /*of*/) {
  using Kind = ConsistencyKind;
  return std::array{std::pair{Kind::kPoint, "point"},
                    std::pair{Kind::kDisparity, "disparity"},
                    std::pair{Kind::kLine, "line"},
                    std::pair{Kind::kRightLine, "right_line"},
                    std::pair{Kind::kSegment, "segment"},
                    std::pair{Kind::kRightSegment, "right_segment"},
                    std::pair{Kind::kPointLandmark, "point_landmark"},
                    std::pair{Kind::kLineLandmark, "line_landmark"},
                    std::pair{Kind::kCausal1s, "causal_1s"},
                    std::pair{Kind::kCausal5s, "causal_5s"},
                    std::pair{Kind::kFinal1s, "final_1s"},
                    std::pair{Kind::kFinal5s, "final_5s"}};
}

// An error and its normalized square. What does not apply to its kind is zero.
struct ConsistencySample {
  ConsistencyKind kind = ConsistencyKind::kPoint;
  // Normalized squared error e^T S^-1 e (NEES), with S the promised covariance of e, and the number
  // of components of e. Infinite for an error that belongs to nothing.
  double nees = 0;
  int dimensions = 1;
  double length = 0;       // of a segment, px
  double contrast = 0;     // gradient across a segment, grey levels per pixel
  double from_middle = 0;  // distance from the image's middle, relative to half the diagonal
  int octave = 0;          // of a corner
  int earlier = 0;         // earlier keyframes with the landmark
  // Depth over the (geometric) mean of the depths from which earlier keyframes saw it, less 1.
  double approach = 0;
  double sigma_px = 0;  // deviation of the feature (LineFeature, PointFeature)
  // The components of e for segments, in px: the distance of the middle from the expected line, and
  // half the difference of the distances of end and start; and the deviations promised for both.
  Eigen::Vector2d across_px = Eigen::Vector2d::Zero();
  Eigen::Vector2d promised_px = Eigen::Vector2d::Zero();
};

// Poses cam_from_world of the rectified camera by keyframe. The unit is that of the camera's
// baseline where it has one.
using KeyFramePoses = std::map<KeyFrameId, Rigid3>;

// Returns the 90 % quantile of the chi2 distribution with 1 to 6 degrees of freedom.
double Chi2Limit90(int dof);

// Returns true if the error is within its 90 % interval.
inline bool IsInside(const ConsistencySample& sample) {
  return sample.nees <= Chi2Limit90(sample.dimensions);
}

}  // namespace plumbline

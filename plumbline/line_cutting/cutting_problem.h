// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/options.h"
#include "plumbline/geometry/rectified_camera.h"
#include "plumbline/geometry/se3.h"
#include "plumbline/geometry/segment.h"

#include <array>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <Eigen/Core>

// Input, result and options of good line cutting (Zhao and Vela, ECCV 2018; cut_lines.h). Equations
// are those of that paper, called the second paper in descriptions of options.
namespace plumbline {

// Pose information of the two cut points of a line, which cutting maximizes.
enum class CuttingInformation {
  // J^T W J: the two cut points are independent, as in the paper.
  kIndependent,
  kPrinted,  // eq. 5 to the letter
  // J^T C^-1 J with the covariance between the cut points; cutting then changes nothing.
  kCorrelated,
};
// Covariance of the ends of a line for cutting.
enum class CuttingEnds {
  kLandmark,  // from the information of the line
  // Equal for all ends in image and inverse depth, as the paper assumes.
  kInverseDepth,
};

constexpr auto EnumNames(std::type_identity<CuttingInformation>) {
  return std::array{std::pair{CuttingInformation::kIndependent, "independent"},
                    std::pair{CuttingInformation::kPrinted, "printed"},
                    std::pair{CuttingInformation::kCorrelated, "correlated"}};
}
constexpr auto EnumNames(std::type_identity<CuttingEnds>) {
  return std::array{std::pair{CuttingEnds::kLandmark, "landmark"},
                    std::pair{CuttingEnds::kInverseDepth, "inverse_depth"}};
}

// Settings of line cutting in a run.
struct CuttingOptions {
  std::string method = "none";
  CuttingInformation information = CuttingInformation::kIndependent;
  CuttingEnds ends = CuttingEnds::kLandmark;
  double end_sigma = 0.005;
};

template <class Visitor>
void VisitFields(Visitor&& visit, CuttingOptions& o) {
  visit("method",
        o.method,
        "of cutting lines before the pose is optimized: none, greedy (one line after the other, "
        "once)",
        Methods{{"none", "greedy"}});
  visit("information",
        o.information,
        "what cutting maximizes: independent (errors of the two cut points taken as independent), "
        "printed (eq 5 of the second paper), correlated (as they are; cutting gains nothing)");
  visit("ends",
        o.ends,
        "how well the ends of a line are known: landmark (as its information says), inverse_depth "
        "(end_sigma in image and inverse depth of the camera that made the line, all alike, as the "
        "second paper assumes)");
  visit("end_sigma",
        o.end_sigma,
        "deviation with inverse_depth: of the inverse depth [1/m], of column and row in units of "
        "the focal length (the second paper simulates 0.005 and 0.015)",
        Range{1e-6, 1});
}

// The options of cutting that went, and what serves instead.
inline std::vector<RemovedOption> RemovedOptions(std::type_identity<CuttingOptions> /*of*/) {
  return {{"drop_share",
           "it is fixed at 0.3 (kDropShare) in builds with the laboratory, which have "
           "cutting.method=drop",
           "0.3"},
          {"budget",
           "all points and lines decide about the pose (0); builds with the laboratory have "
           "cutting.method=best_80",
           "0"}};
}

// A matched 3D line, linearized at the current pose estimate.
struct CuttableLine {
  Segment3 segment_in_cam;  // ends at ratio 0 and 1, in the camera frame; both with z > 1e-6 m
  // Covariances of the ends, camera frame, m^2; positive semidefinite. The errors of the two ends
  // are independent.
  Eigen::Matrix3d start_covariance;
  Eigen::Matrix3d end_covariance;
  Eigen::Vector3d image_line;  // line as measured, scaled as by LineThrough(Segment2), pixels
  // Deviation of the measured line across itself [px]; greater than 0.
  double sigma_px = 1;
};

// Input of CutLines for one frame: camera, lines, and the other pose information.
struct CuttingProblem {
  RectifiedCamera camera;
  std::vector<CuttableLine> lines;
  // Information of all other measurements of the pose, above all points: J^T W J in whitened
  // residuals for the left perturbation exp([rotation, translation]) cam_from_world. Constant under
  // changes of the cuts (eq. 7).
  Matrix6d other_information = Matrix6d::Zero();
};

// Returns the covariance (3 x 3, m^2, camera frame) of a point from independent deviations of its
// column and row in the image (sigma_px) and of its inverse depth (sigma_inverse_depth, 1/m):
// "constant in inverse depth" of section 6. To first order, with X = (u, v, 1)/rho: dX/du = e_x z /
// fx, dX/dv = e_y z / fy, dX/drho = -z X. `point_in_cam` must have z > 0 (BugError otherwise).
//
// For a point measured in an earlier camera, compute that camera's covariance and rotate it into
// the current one: R Sigma R^T with R of cam_from_earlier.
Eigen::Matrix3d CovarianceFromInverseDepth(const RectifiedCamera& camera,
                                           const Eigen::Vector3d& point_in_cam,
                                           double sigma_px,
                                           double sigma_inverse_depth);

// Returns the covariance of a point from a stereo pair or a depth image. The disparity fx *
// baseline / z has the deviation sigma_disparity_px, and so the inverse depth sigma_disparity_px /
// (fx * baseline). The camera's baseline must be positive (BugError otherwise).
Eigen::Matrix3d CovarianceFromDisparity(const RectifiedCamera& camera,
                                        const Eigen::Vector3d& point_in_cam,
                                        double sigma_px,
                                        double sigma_disparity_px);

// A cut of a line: the piece from ratio `first` to ratio `second` of its 3D segment, X(a) = (1 - a)
// start + a end, 0 <= first <= second <= 1. With equal ratios one point counts twice.
struct LineCut {
  double first = 0, second = 1;
  bool used = true;  // false: the line is dropped

  // True if both are equal bit by bit.
  bool operator==(const LineCut&) const = default;
};

// Prior information in every direction of the pose [rad^-2 and map scale^-2]. It keeps the
// information matrix of few lines regular, and is negligible otherwise.
inline constexpr double kPriorInformation = 1e-6;

// Returns the point of a segment at a ratio: 0 is its start, 1 its end.
inline Eigen::Vector3d PointAt(const Segment3& segment, double ratio) {
  return (1 - ratio) * segment.start + ratio * segment.end;
}
// Returns the piece of a segment within a cut.
inline Segment3 CutSegment(const Segment3& segment, const LineCut& cut) {
  return {PointAt(segment, cut.first), PointAt(segment, cut.second)};
}
// Returns the ratio, 0 to 1, of the image of PointAt(segment, ratio) between the images of the
// ends.
inline double ImageRatio(const Segment3& segment_in_cam, double ratio) {
  const double end = ratio * segment_in_cam.end.z();
  return end / ((1 - ratio) * segment_in_cam.start.z() + end);
}

}  // namespace plumbline

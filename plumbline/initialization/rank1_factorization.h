// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace plumbline {

// Measurements of the reference's points in one later frame.
struct Rank1View {
  Eigen::Quaterniond reference_from_cam;  // rotation alone
  // Unit vector to the camera's centre, in the reference frame. Its sign does not matter.
  Eigen::Vector3d centre_direction = Eigen::Vector3d::UnitX();
  std::vector<Eigen::Vector2d> points;  // ideal image coordinates (x/z, y/z) of each point
  // Standard deviation of each coordinate of each point, in the same ideal coordinates (pixels /
  // focal length); 0 if this frame does not show the point.
  std::vector<double> sigmas;
};

// Settings of FactorizeRank1.
struct Rank1Options {
  // Rounds of alternation between centres and points, each with new robust weights (Lee and Hwang,
  // ICCV 2019, eq. 5). 0: the singular vectors alone, in which unknown entries count as zero.
  int iterations = 5;
  // Rays nearer to the line of the centres than this [radians] do not determine the length of the
  // motion.
  double min_epipole_angle = 0.02;
  double loss_width = 2.385;  // width of the Cauchy loss, in standard deviations
};

// A matrix stored by rows, so that the numbers of all points for one coordinate of one frame are
// contiguous.
using Rank1Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// The centres and distances whose product is closest to the measurement matrix.
struct Rank1Solution {
  // Centres of the views, in the frame of the reference; all of them together have unit length.
  std::vector<Eigen::Vector3d> centres;
  // Inverse distance of each point along its unit ray; 0 if unknown.
  std::vector<double> inverse_distances;
  int in_front = 0;   // points with a positive inverse distance
  int solved = 0;     // points with an inverse distance
  double spread = 0;  // spread of the residuals by their median, in standard deviations
};

// The 3m x n matrix of eq. 4. Column k has, frame by frame, the camera centre in units of the
// distance of point k. Without noise it is the product of centres and inverse distances.
//
// It follows eq. 1-3 as corrected. Let p be the unit ray of the point in the reference, q its
// measured ray in the frame, rotated into the reference (printed: p itself rotated), t the
// direction of the centre and c = t . q. The lengths of t and q for which a = s0 t and b = p - s q
// coincide are
//
//   s0 = (t.p - c q.p) / (1 - c^2),  s = (q.p - c t.p) / (1 - c^2)
//
// and the entry is (a + b) / 2. Its error is that of the rays over the sine of the angle between t
// and q, which gives the weights of the factorization.
class Rank1Matrix {
 public:
  // All views must have as many points and sigmas as `reference_points` (BugError otherwise).
  Rank1Matrix(std::span<const Eigen::Vector2d> reference_points,
              std::span<const Rank1View> views,
              double min_epipole_angle);

  const Rank1Rows& entries() const { return entries_; }  // 3m x n; 0 if unknown
  const Rank1Rows& weights() const { return weights_; }  // m x n, 1 / variance; 0 if unknown

 private:
  using Row = Eigen::Array<double, 1, Eigen::Dynamic>;
  struct RayRows {
    Row x, y, z;
  };
  static RayRows UnitRays(std::span<const Eigen::Vector2d> points);
  // Fills the rows of one view. `p` are the unit rays in the reference.
  void SetView(Eigen::Index i, const Rank1View& view, const RayRows& p, double min_squared_sine);

  Rank1Rows entries_;
  Rank1Rows weights_;
};

// The leading pair of a dense matrix: the closest product of centres (3m) and inverse distances
// (n), with |centres| = 1. The sign makes most inverse distances positive.
struct RankOne {
  Eigen::VectorXd centres;
  Eigen::VectorXd inverse_distances;
};
// Computes the leading pair by power iteration on the small Gram matrix. Cost: O(9 m^2 n).
RankOne LeadingPair(const Rank1Rows& entries);

// Solves for all centres and inverse distances at once (eq. 5).
//
// The first solution is that of an SVD, with columns scaled by their noise and unknown entries left
// zero. Then points and cameras are solved for in turn by weighted least squares, which minimizes
// the reweighted error, as an SVD cannot. The weights come from the noise of each entry and the
// Cauchy loss of its residual, whose scale is estimated by the median.
//
//   reference_points  ideal image coordinates (x/z, y/z) in the reference
//   views             at least one
//   returns           nullopt if fewer than 3 points have an entry, or a frame has none
//   cost              O(m n) for each iteration, with m views and n points
std::optional<Rank1Solution> FactorizeRank1(std::span<const Eigen::Vector2d> reference_points,
                                            std::span<const Rank1View> views,
                                            const Rank1Options& options = {});

}  // namespace plumbline

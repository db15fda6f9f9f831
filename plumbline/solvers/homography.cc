// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/solvers/homography.h"

#include "plumbline/geometry/symmetric_matrix.h"
#include "plumbline/solvers/ray_match.h"

#include <cmath>
#include <limits>

#include <Eigen/Dense>

namespace plumbline {
namespace {

// Returns the matrix that takes the projective basis e1, e2, e3, (1, 1, 1) to four points.
std::optional<Eigen::Matrix3d> FromBasis(const Eigen::Vector3d& p,
                                         const Eigen::Vector3d& q,
                                         const Eigen::Vector3d& r,
                                         const Eigen::Vector3d& s) {
  Eigen::Matrix3d columns;
  columns << p, q, r;
  Eigen::Matrix3d inverse;
  bool invertible = false;
  columns.computeInverseWithCheck(inverse, invertible, 1e-12);
  if (!invertible) return std::nullopt;
  const Eigen::Vector3d weights = inverse * s;
  if (!(weights.cwiseAbs().minCoeff() > 1e-9 * weights.cwiseAbs().maxCoeff())) return std::nullopt;
  return columns * weights.asDiagonal();
}

// Returns the mean variance of a coordinate of x_b - H x_a / (H x_a).z.
double TransferVariance(const Eigen::Matrix3d& H,
                        const RayMatch& match,
                        const Eigen::Vector3d& mapped) {
  const Eigen::Vector2d place = mapped.head<2>() / mapped.z();
  const Eigen::Matrix2d J =
      (H.topLeftCorner<2, 2>() - place * H.bottomLeftCorner<1, 2>()) / mapped.z();
  return match.sigma_b * match.sigma_b + 0.5 * J.squaredNorm() * match.sigma_a * match.sigma_a;
}

}  // namespace

std::optional<Eigen::Matrix3d> HomographyFromFourPoints(std::span<const RayMatch, 4> m) {
  const auto in_a = FromBasis(
      m[0].a.homogeneous(), m[1].a.homogeneous(), m[2].a.homogeneous(), m[3].a.homogeneous());
  const auto in_b = FromBasis(
      m[0].b.homogeneous(), m[1].b.homogeneous(), m[2].b.homogeneous(), m[3].b.homogeneous());
  if (!in_a || !in_b) return std::nullopt;
  return (*in_b * in_a->inverse()).normalized();
}

std::optional<Eigen::Matrix3d> HomographyFromPoints(std::span<const RayMatch> matches,
                                                    const Eigen::Matrix3d* start) {
  if (matches.size() < 4) return std::nullopt;
  Normalization in_a, in_b;
  if (start == nullptr) {
    in_a = NormalizationOf(matches, &RayMatch::a);
    in_b = NormalizationOf(matches, &RayMatch::b);
  }
  Eigen::Matrix<double, 9, 9> normal = Eigen::Matrix<double, 9, 9>::Zero();
  for (const RayMatch& m : matches) {
    const Eigen::Vector3d a = in_a.Apply(m.a).homogeneous();
    const Eigen::Vector2d b = in_b.Apply(m.b);
    double weight = 1;
    if (start != nullptr) {
      const Eigen::Vector3d mapped = *start * a;
      weight = 1 / (mapped.z() * std::sqrt(TransferVariance(*start, m, mapped)));
    }
    Eigen::Matrix<double, 9, 2> rows = Eigen::Matrix<double, 9, 2>::Zero();
    rows.block<3, 1>(0, 0) = weight * a;
    rows.block<3, 1>(6, 0) = -weight * b.x() * a;
    rows.block<3, 1>(3, 1) = weight * a;
    rows.block<3, 1>(6, 1) = -weight * b.y() * a;
    normal.selfadjointView<Eigen::Lower>().rankUpdate(rows);
  }
  const Eigenpairs<9> eigen = EigenpairsOf<9>(normal);
  if (!(eigen.values(1) > 1e-12 * eigen.values(8))) return std::nullopt;
  const Eigen::Matrix<double, 9, 1> h = eigen.vectors.col(0);
  const Eigen::Matrix3d H =
      Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(h.data());
  if (start != nullptr) return H;
  return Eigen::Matrix3d(in_b.Matrix().inverse() * H * in_a.Matrix());
}

double SquaredTransferError(const Eigen::Matrix3d& homography, const RayMatch& match) {
  const Eigen::Matrix3d& H = homography;
  const Eigen::Vector3d mapped = H * match.a.homogeneous();
  const double z = mapped.z();
  if (z == 0) return std::numeric_limits<double>::infinity();
  // The error times z and its derivative times z^2 need no division.
  const Eigen::Vector2d error = z * match.b - mapped.head<2>();
  const Eigen::Matrix2d J =
      z * H.topLeftCorner<2, 2>() - mapped.head<2>() * H.bottomLeftCorner<1, 2>();
  const double zz = z * z;
  const double variance = zz * zz * match.sigma_b * match.sigma_b +
                          0.5 * J.squaredNorm() * match.sigma_a * match.sigma_a;
  return zz * error.squaredNorm() / variance;
}

std::vector<PlanarMotion> MotionsFromHomography(const Eigen::Matrix3d& homography) {
  // Eigenvalues ascend; the columns of V are the right singular vectors.
  const Eigenpairs<3> eigen = EigenpairsOf<3>(homography.transpose() * homography);
  const Eigen::Vector3d& squares = eigen.values;
  if (!(squares(0) > 1e-18 * squares(2))) return {};
  // R + t n^T / d has the middle singular value 1. Its determinant is the ratio of the distances of
  // the plane from the two cameras, which is positive.
  const double sign = homography.determinant() < 0 ? -1 : 1;
  const Eigen::Matrix3d H = sign / std::sqrt(squares(1)) * homography;
  const double largest = squares(2) / squares(1);
  const double smallest = squares(0) / squares(1);
  Eigen::Matrix3d V = eigen.vectors.rowwise().reverse();
  if (V.determinant() < 0) V = -V;
  if (largest - smallest < 1e-12) {
    PlanarMotion turn;
    turn.b_from_a.rotation = Eigen::Quaterniond(H).normalized();
    return {turn};
  }
  const double c = std::sqrt(std::max(0.0, (1 - smallest) / (largest - smallest)));
  const double d = std::sqrt(std::max(0.0, (largest - 1) / (largest - smallest)));
  std::vector<PlanarMotion> motions;
  for (const double side : {1.0, -1.0}) {
    // u and v2 span a plane in which H keeps lengths, so that it turns there as the camera does.
    const Eigen::Vector3d v2 = V.col(1);
    const Eigen::Vector3d u = c * V.col(0) + side * d * V.col(2);
    const Eigen::Vector3d normal = v2.cross(u);
    Eigen::Matrix3d before;
    before << v2, u, normal;
    Eigen::Matrix3d after;
    after << H * v2, H * u, (H * v2).cross(H * u);
    const Eigen::Matrix3d R = after * before.transpose();
    const Eigen::Vector3d t = (H - R) * normal;
    const Eigen::Quaterniond rotation = Eigen::Quaterniond(R).normalized();
    motions.push_back({{rotation, t}, normal});
    motions.push_back({{rotation, -t}, -normal});
  }
  return motions;
}

}  // namespace plumbline

// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/initialization/window_covariance.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace plumbline {
namespace {

using Matrix23 = Eigen::Matrix<double, 2, 3>;
using Matrix63 = Eigen::Matrix<double, 6, 3>;

// Whitened error of a measurement and its derivative with respect to the point in the camera.
struct Measured {
  Eigen::Vector2d error = Eigen::Vector2d::Zero();
  Matrix23 J = Matrix23::Zero();
};

std::optional<Measured> Measure(const Eigen::Vector3d& in_cam,
                                const Eigen::Vector2d& seen,
                                double sigma) {
  if (!(in_cam.z() > 0)) return std::nullopt;
  const Eigen::Vector2d place = in_cam.hnormalized();
  Measured result;
  result.error = (seen - place) / sigma;
  result.J << Eigen::Matrix2d::Identity(), -place;
  result.J /= in_cam.z() * sigma;
  return result;
}

// A point's part of the normal equations, eliminated.
struct EliminatedPoint {
  Eigen::Matrix3d inverse;  // V^-1
  std::vector<Matrix63> W;  // by view; zero where it is not seen
  bool known = false;
};

struct Rotations {
  std::vector<Eigen::Matrix3d> of_view;

  explicit Rotations(const WindowSolution& solution) {
    for (const Rigid3& pose : solution.cam_from_reference) {
      of_view.push_back(pose.rotation.toRotationMatrix());
    }
  }
};

EliminatedPoint Eliminate(const WindowTracks& tracks,
                          const WindowSolution& solution,
                          const Rotations& rotations,
                          std::size_t k,
                          double noise,
                          double max_chi2,
                          Eigen::MatrixXd& information) {
  EliminatedPoint point;
  const Eigen::Vector3d& X = solution.points[k];
  const auto in_reference =
      Measure(X, tracks.reference.points[k], noise * tracks.reference.sigmas[k]);
  if (!solution.is_known[k] || !in_reference) return point;
  Eigen::Matrix3d V = in_reference->J.transpose() * in_reference->J;
  point.W.assign(tracks.views.size(), Matrix63::Zero());
  std::vector<Matrix6d> H(tracks.views.size(), Matrix6d::Zero());
  int seen = 0;
  for (std::size_t i = 0; i < tracks.views.size(); ++i) {
    const TrackedPoints& view = tracks.views[i];
    if (!view.Has(k)) continue;
    const Eigen::Vector3d in_cam = solution.cam_from_reference[i] * X;
    const auto measured = Measure(in_cam, view.points[k], noise * view.sigmas[k]);
    if (!measured || measured->error.squaredNorm() > max_chi2) continue;
    ++seen;
    Eigen::Matrix<double, 2, 6> J_pose;
    J_pose << -measured->J * Skew(in_cam), measured->J;
    const Matrix23 J_point = measured->J * rotations.of_view[i];
    V += J_point.transpose() * J_point;
    H[i] = J_pose.transpose() * J_pose;
    point.W[i] = J_pose.transpose() * J_point;
  }
  const Eigen::LLT<Eigen::Matrix3d> factor(V);
  if (seen == 0 || factor.info() != Eigen::Success || !(factor.rcond() > 1e-12)) return point;
  point.known = true;
  point.inverse = factor.solve(Eigen::Matrix3d::Identity());
  for (std::size_t i = 0; i < H.size(); ++i) {
    const Matrix63 WV = point.W[i] * point.inverse;
    const auto row = static_cast<Eigen::Index>(6 * i);
    information.block<6, 6>(row, row) += H[i];
    for (std::size_t j = 0; j <= i; ++j) {
      const auto column = static_cast<Eigen::Index>(6 * j);
      information.block<6, 6>(row, column) -= WV * point.W[j].transpose();
    }
  }
  return point;
}

// The direction in which the whole grows: all centres away from the reference.
Eigen::VectorXd ScaleDirection(const WindowSolution& solution) {
  Eigen::VectorXd direction =
      Eigen::VectorXd::Zero(static_cast<Eigen::Index>(6 * solution.cam_from_reference.size()));
  Eigen::Index row = 3;
  for (const Rigid3& pose : solution.cam_from_reference) {
    direction.segment<3>(row) = pose.translation;
    row += 6;
  }
  return direction.normalized();
}

std::optional<Eigen::MatrixXd> InvertWithScaleHeld(Eigen::MatrixXd information,
                                                   const WindowSolution& solution) {
  information = information.selfadjointView<Eigen::Lower>();
  const Eigen::VectorXd scale = ScaleDirection(solution);
  // Rotations and translations in units of their own, for the condition.
  const Eigen::VectorXd unit = information.diagonal().cwiseMax(1e-300).cwiseSqrt();
  const double weight = information.trace();
  information += weight * scale * scale.transpose();
  const Eigen::MatrixXd scaled =
      unit.cwiseInverse().asDiagonal() * information * unit.cwiseInverse().asDiagonal();
  const Eigen::LDLT<Eigen::MatrixXd> factor(scaled);
  if (factor.info() != Eigen::Success || !factor.isPositive()) return std::nullopt;
  if (!(factor.vectorD().minCoeff() > 1e-13 * factor.vectorD().maxCoeff())) return std::nullopt;
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(scaled.rows(), scaled.cols());
  return unit.cwiseInverse().asDiagonal() * factor.solve(identity) *
         unit.cwiseInverse().asDiagonal();
}

// How the logarithm of a point's depth follows the poses.
Eigen::VectorXd DepthRow(const EliminatedPoint& point, double depth) {
  Eigen::VectorXd row(static_cast<Eigen::Index>(6 * point.W.size()));
  const Eigen::Vector3d to_point = point.inverse.col(2) / depth;
  for (std::size_t i = 0; i < point.W.size(); ++i) {
    row.segment<6>(static_cast<Eigen::Index>(6 * i)) = -point.W[i] * to_point;
  }
  return row;
}

// Of the depths, after a common factor was taken off: the mean of their logarithms, weighted so
// that points too far away to have a depth do not set it.
std::vector<double> RelativeDepthSigmas(const WindowSolution& solution,
                                        const std::vector<EliminatedPoint>& points,
                                        const Eigen::MatrixXd& poses) {
  std::vector<double> sigmas(points.size(), -1);
  std::vector<Eigen::VectorXd> rows(points.size());
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(poses.rows());
  double weights = 0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (!points[k].known) continue;
    const double z = solution.points[k].z();
    const double weight = z * z / points[k].inverse(2, 2);
    rows[k] = DepthRow(points[k], z);
    mean += weight * rows[k];
    weights += weight;
  }
  if (weights > 0) mean /= weights;
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (!points[k].known) continue;
    const double z = solution.points[k].z();
    const Eigen::VectorXd row = rows[k] - mean;
    const double variance = points[k].inverse(2, 2) / (z * z) + row.dot(poses * row);
    sigmas[k] = std::sqrt(std::max(0.0, variance));
  }
  return sigmas;
}

}  // namespace

std::optional<WindowCovariance> ComputeWindowCovariance(const WindowTracks& tracks,
                                                        const WindowSolution& solution,
                                                        double noise,
                                                        double max_chi2) {
  const auto size = static_cast<Eigen::Index>(6 * tracks.views.size());
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(size, size);
  const Rotations rotations(solution);
  std::vector<EliminatedPoint> points;
  points.reserve(tracks.size());
  for (std::size_t k = 0; k < tracks.size(); ++k) {
    points.push_back(Eliminate(tracks, solution, rotations, k, noise, max_chi2, information));
  }
  auto poses = InvertWithScaleHeld(std::move(information), solution);
  if (!poses) return std::nullopt;
  WindowCovariance result;
  result.relative_depth_sigmas = RelativeDepthSigmas(solution, points, *poses);
  result.poses = std::move(*poses);
  return result;
}

PoseAccuracy AccuracyOf(const WindowSolution& solution,
                        const WindowCovariance& covariance,
                        int view) {
  const auto row = static_cast<Eigen::Index>(6 * view);
  const Rigid3& pose = solution.cam_from_reference[static_cast<std::size_t>(view)];
  const double length = pose.translation.norm();
  const Eigen::Vector3d t = pose.translation / length;
  const Eigen::Matrix3d across = (Eigen::Matrix3d::Identity() - t * t.transpose()) / length;
  const auto largest = [](const Eigen::Matrix3d& m) {
    return std::sqrt(
        std::max(0.0,
                 Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(m, Eigen::EigenvaluesOnly)
                     .eigenvalues()(2)));
  };
  // exp([w, v]) T moves the centre by -R^T v: the shift alone turns its direction.
  return {largest(covariance.poses.block<3, 3>(row, row)),
          largest(across * covariance.poses.block<3, 3>(row + 3, row + 3) * across)};
}

}  // namespace plumbline

// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/initialization/window_covariance.h"

#include "plumbline/geometry/covariance.h"
#include "plumbline/initialization/window_lines.h"
#include "plumbline/optimization/residuals.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include <Eigen/Cholesky>

namespace plumbline {
namespace {

using Matrix23 = Eigen::Matrix<double, 2, 3>;

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

// A landmark's part of the normal equations, eliminated: N parameters.
template <int N>
struct Eliminated {
  using Block = Eigen::Matrix<double, 6, N>;
  Eigen::Matrix<double, N, N> inverse;  // V^-1
  std::vector<Block> W;                 // by view; zero where it is not seen
  bool known = false;
};

// What a landmark and the views that see it have in common.
template <int N>
struct NormalBlocks {
  explicit NormalBlocks(std::size_t views)
      : W(views, Eigen::Matrix<double, 6, N>::Zero()), H(views, Matrix6d::Zero()) {}

  void Add(std::size_t view,
           const Eigen::Matrix<double, 2, 6>& J_pose,
           const Eigen::Matrix<double, 2, N>& J) {
    V += J.transpose() * J;
    H[view] = J_pose.transpose() * J_pose;
    W[view] = J_pose.transpose() * J;
  }

  Eigen::Matrix<double, N, N> V = Eigen::Matrix<double, N, N>::Zero();
  std::vector<Eigen::Matrix<double, 6, N>> W;
  std::vector<Matrix6d> H;
};

// Takes the landmark out and adds what it says about the poses to the lower triangle.
template <int N>
Eliminated<N> Eliminate(NormalBlocks<N> blocks, Eigen::MatrixXd& information) {
  Eliminated<N> landmark;
  const Eigen::LLT<Eigen::Matrix<double, N, N>> factor(blocks.V);
  if (factor.info() != Eigen::Success || !(factor.rcond() > 1e-12)) return landmark;
  landmark.known = true;
  landmark.inverse = factor.solve(Eigen::Matrix<double, N, N>::Identity());
  landmark.W = std::move(blocks.W);
  for (std::size_t i = 0; i < blocks.H.size(); ++i) {
    const typename Eliminated<N>::Block WV = landmark.W[i] * landmark.inverse;
    const auto row = static_cast<Eigen::Index>(6 * i);
    information.block<6, 6>(row, row) += blocks.H[i];
    for (std::size_t j = 0; j <= i; ++j) {
      const auto column = static_cast<Eigen::Index>(6 * j);
      information.block<6, 6>(row, column) -= WV * landmark.W[j].transpose();
    }
  }
  return landmark;
}
using EliminatedPoint = Eliminated<3>;

struct Rotations {
  std::vector<Eigen::Matrix3d> of_view;

  explicit Rotations(const WindowSolution& solution) {
    for (const Rigid3& pose : solution.cam_from_reference) {
      of_view.push_back(pose.rotation.toRotationMatrix());
    }
  }
};

EliminatedPoint EliminatePoint(const WindowTracks& tracks,
                               const WindowSolution& solution,
                               const Rotations& rotations,
                               std::size_t k,
                               double noise,
                               double max_chi2,
                               Eigen::MatrixXd& information) {
  const Eigen::Vector3d& X = solution.points[k];
  const auto in_reference =
      Measure(X, tracks.reference.points[k], noise * tracks.reference.sigmas[k]);
  if (!solution.is_known[k] || !in_reference) return {};
  NormalBlocks<3> blocks(tracks.views.size());
  blocks.V = in_reference->J.transpose() * in_reference->J;
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
    blocks.Add(i, J_pose, measured->J * rotations.of_view[i]);
  }
  if (seen == 0) return {};
  return Eliminate(std::move(blocks), information);
}

// A line that fits all views that show it.
void EliminateLine(const WindowTracks& tracks,
                   const WindowSolution& solution,
                   std::size_t k,
                   double noise,
                   Eigen::MatrixXd& information) {
  const OrthonormalLine line = ToOrthonormal(*solution.lines[k]);
  NormalBlocks<4> blocks(tracks.views.size());
  const auto in_reference =
      EvaluateLine(kIdealCamera, {}, line, MeasurementOf(tracks.lines.reference, k, noise));
  if (!in_reference) return;
  blocks.V = in_reference->J_line.transpose() * in_reference->J_line;
  for (std::size_t i = 0; i < tracks.lines.views.size(); ++i) {
    const TrackedLines& view = tracks.lines.views[i];
    if (!view.Has(k)) continue;
    const auto measured = EvaluateLine(
        kIdealCamera, solution.cam_from_reference[i], line, MeasurementOf(view, k, noise));
    if (!measured) return;
    blocks.Add(i, measured->J_pose, measured->J_line);
  }
  Eliminate(std::move(blocks), information);
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
                                                        double max_chi2,
                                                        double line_noise) {
  const auto size = static_cast<Eigen::Index>(6 * tracks.views.size());
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(size, size);
  const Rotations rotations(solution);
  std::vector<EliminatedPoint> points;
  points.reserve(tracks.size());
  for (std::size_t k = 0; k < tracks.size(); ++k) {
    points.push_back(EliminatePoint(tracks, solution, rotations, k, noise, max_chi2, information));
  }
  for (const std::size_t k : LinesThatFit(tracks, solution)) {
    EliminateLine(tracks, solution, k, line_noise, information);
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
  // exp([w, v]) T moves the centre by -R^T v: the shift alone turns its direction.
  return {LargestSigma(covariance.poses.block<3, 3>(row, row)),
          LargestSigma(across * covariance.poses.block<3, 3>(row + 3, row + 3) * across)};
}

}  // namespace plumbline

// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/initialization/reconstruction_covariance.h"

#include "plumbline/base/statistics.h"
#include "plumbline/geometry/covariance.h"
#include "plumbline/optimization/residuals.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include <Eigen/Cholesky>

namespace plumbline {
namespace {

using Matrix23 = Eigen::Matrix<double, 2, 3>;

// Whitened error of a measurement, and its derivative by the point in the camera.
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

// The normal equations of a landmark with N parameters and of the views that see it.
template <int N>
struct NormalBlocks {
  using Block = Eigen::Matrix<double, 6, N>;

  explicit NormalBlocks(std::size_t views) : W(views), H(views), sees(views) { Clear(); }

  void Clear() {
    V.setZero();
    std::fill(sees.begin(), sees.end(), char{0});
  }
  void Add(std::size_t view,
           const Eigen::Matrix<double, 2, 6>& J_pose,
           const Eigen::Matrix<double, 2, N>& J) {
    V += J.transpose() * J;
    H[view].noalias() = J_pose.transpose() * J_pose;
    W[view].noalias() = J_pose.transpose() * J;
    sees[view] = 1;
  }

  Eigen::Matrix<double, N, N> V;
  std::vector<Block> W;     // for each view, of use where the view sees the landmark
  std::vector<Matrix6d> H;  // for each view, valid if the view sees the landmark
  std::vector<char> sees;   // for each view
};

// The information of all landmarks about the poses, as blocks of the lower triangle.
class PoseInformation {
 public:
  explicit PoseInformation(std::size_t views)
      : views_(views), blocks_(views * (views + 1) / 2, Matrix6d::Zero()) {}

  // Eliminates a landmark; returns V^-1, or nullopt if the landmark is not determined.
  template <int N>
  std::optional<Eigen::Matrix<double, N, N>> Eliminate(const NormalBlocks<N>& blocks) {
    const Eigen::LLT<Eigen::Matrix<double, N, N>> factor(blocks.V);
    if (factor.info() != Eigen::Success) return std::nullopt;
    const Eigen::Matrix<double, N, N> inverse =
        factor.solve(Eigen::Matrix<double, N, N>::Identity());
    if (!(OneNorm<N>(blocks.V) * OneNorm<N>(inverse) < 1e12)) return std::nullopt;
    for (std::size_t i = 0; i < views_; ++i) {
      if (!blocks.sees[i]) continue;
      Block(i, i) += blocks.H[i];
      const typename NormalBlocks<N>::Block WV = blocks.W[i] * inverse;
      for (std::size_t j = 0; j <= i; ++j) {
        if (blocks.sees[j]) Block(i, j).noalias() -= WV * blocks.W[j].transpose();
      }
    }
    return inverse;
  }

  Eigen::MatrixXd LowerTriangle() {
    const auto size = static_cast<Eigen::Index>(6 * views_);
    Eigen::MatrixXd lower = Eigen::MatrixXd::Zero(size, size);
    for (std::size_t i = 0; i < views_; ++i) {
      for (std::size_t j = 0; j <= i; ++j) {
        lower.block<6, 6>(static_cast<Eigen::Index>(6 * i), static_cast<Eigen::Index>(6 * j)) =
            Block(i, j);
      }
    }
    return lower;
  }

 private:
  template <int N>
  static double OneNorm(const Eigen::Matrix<double, N, N>& matrix) {
    return matrix.cwiseAbs().colwise().sum().maxCoeff();
  }
  Matrix6d& Block(std::size_t row, std::size_t column) {
    return blocks_[row * (row + 1) / 2 + column];
  }

  std::size_t views_;
  std::vector<Matrix6d> blocks_;
};

// The dependence of the depths of known points on the poses.
struct Depths {
  std::vector<std::size_t> points;
  std::vector<double> variances;  // variances of the log depths with the poses held
  // One column for each point: minus the derivative of its log depth by the poses.
  Eigen::MatrixXd columns;

  explicit Depths(const FeatureTracks& tracks)
      : columns(6 * tracks.views.size(), tracks.reference.points.size()) {}

  void Add(std::size_t k, const NormalBlocks<3>& blocks, const Eigen::Matrix3d& inverse, double z) {
    auto column = columns.col(static_cast<Eigen::Index>(points.size()));
    points.push_back(k);
    variances.push_back(inverse(2, 2) / (z * z));
    const Eigen::Vector3d to_point = inverse.col(2) / z;
    for (std::size_t i = 0; i < blocks.W.size(); ++i) {
      auto part = column.segment<6>(static_cast<Eigen::Index>(6 * i));
      if (blocks.sees[i]) {
        part.noalias() = blocks.W[i] * to_point;
      } else {
        part.setZero();
      }
    }
  }
};

// Builds the normal equations of points.
class PointEquations {
 public:
  PointEquations(const FeatureTracks& tracks, const Reconstruction& reconstruction)
      : tracks_(tracks), reconstruction_(reconstruction) {
    for (const Rigid3& pose : reconstruction.cam_from_reference) {
      rotations_.push_back(pose.rotation.toRotationMatrix());
    }
  }

  // Sets the equations of point k; returns false if it has no position or no view sees it.
  bool Set(std::size_t k, double noise, double max_chi2, NormalBlocks<3>& blocks) const {
    const Eigen::Vector3d& X = reconstruction_.points[k];
    const auto in_reference =
        Measure(X, tracks_.reference.points[k], noise * tracks_.reference.sigmas[k]);
    if (!reconstruction_.is_known[k] || !in_reference) return false;
    blocks.Clear();
    blocks.V = in_reference->J.transpose() * in_reference->J;
    bool seen = false;
    for (std::size_t i = 0; i < tracks_.views.size(); ++i) {
      const ViewPoints& view = tracks_.views[i];
      if (!view.Has(k)) continue;
      const Eigen::Vector3d in_cam =
          rotations_[i] * X + reconstruction_.cam_from_reference[i].translation;
      const auto measured = Measure(in_cam, view.points[k], noise * view.sigmas[k]);
      if (!measured || measured->error.squaredNorm() > max_chi2) continue;
      seen = true;
      Eigen::Matrix<double, 2, 6> J_pose;
      J_pose << -measured->J * Skew(in_cam), measured->J;
      blocks.Add(i, J_pose, measured->J * rotations_[i]);
    }
    return seen;
  }

 private:
  const FeatureTracks& tracks_;
  const Reconstruction& reconstruction_;
  std::vector<Eigen::Matrix3d> rotations_;
};

// Eliminates a line that fits all views that show it.
void EliminateLine(const FeatureTracks& tracks,
                   const Reconstruction& reconstruction,
                   std::size_t k,
                   double noise,
                   PoseInformation& information) {
  const OrthonormalLine line = ToOrthonormal(*reconstruction.lines[k]);
  NormalBlocks<4> blocks(tracks.views.size());
  const auto in_reference =
      EvaluateLine(kIdealCamera, {}, line, MeasurementOf(tracks.lines.reference, k, noise));
  if (!in_reference) return;
  blocks.V = in_reference->J_line.transpose() * in_reference->J_line;
  for (std::size_t i = 0; i < tracks.lines.views.size(); ++i) {
    const ViewLines& view = tracks.lines.views[i];
    if (!view.Has(k)) continue;
    const auto measured = EvaluateLine(
        kIdealCamera, reconstruction.cam_from_reference[i], line, MeasurementOf(view, k, noise));
    if (!measured) return;
    blocks.Add(i, measured->J_pose, measured->J_line);
  }
  information.Eliminate(blocks);
}

// Returns the direction in which the whole reconstruction grows: all centres move away from the
// reference.
Eigen::VectorXd ScaleDirection(const Reconstruction& reconstruction) {
  Eigen::VectorXd direction = Eigen::VectorXd::Zero(
      static_cast<Eigen::Index>(6 * reconstruction.cam_from_reference.size()));
  Eigen::Index row = 3;
  for (const Rigid3& pose : reconstruction.cam_from_reference) {
    direction.segment<3>(row) = pose.translation;
    row += 6;
  }
  return direction.normalized();
}

std::optional<Eigen::MatrixXd> InvertWithScaleHeld(Eigen::MatrixXd information,
                                                   const Reconstruction& reconstruction) {
  information = information.selfadjointView<Eigen::Lower>();
  const Eigen::VectorXd scale = ScaleDirection(reconstruction);
  // Rotations and translations get units of their own, for the condition of the equations.
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

// Returns the relative deviations of the depths after a common factor is taken off. This factor is
// the mean of the log depths, weighted so that points too far away to have a depth do not set it.
std::vector<double> RelativeDepthSigmas(std::size_t points,
                                        Depths depths,
                                        const Eigen::MatrixXd& poses) {
  std::vector<double> sigmas(points, -1);
  const auto count = static_cast<Eigen::Index>(depths.points.size());
  const Eigen::Map<const Eigen::VectorXd> variances(depths.variances.data(), count);
  auto columns = depths.columns.leftCols(count);
  const Eigen::VectorXd weights = variances.cwiseInverse();
  if (count > 0) columns.colwise() -= (columns * weights / weights.sum()).eval();
  const Eigen::VectorXd by_poses = columns.cwiseProduct(poses * columns).colwise().sum();
  for (Eigen::Index j = 0; j < count; ++j) {
    sigmas[depths.points[static_cast<std::size_t>(j)]] =
        std::sqrt(std::max(0.0, variances(j) + by_poses(j)));
  }
  return sigmas;
}

}  // namespace

std::optional<ReconstructionCovariance> ComputeCovariance(const FeatureTracks& tracks,
                                                          const Reconstruction& reconstruction,
                                                          double noise,
                                                          double max_chi2,
                                                          double line_noise) {
  PoseInformation information(tracks.views.size());
  const PointEquations points(tracks, reconstruction);
  NormalBlocks<3> blocks(tracks.views.size());
  Depths depths(tracks);
  for (std::size_t k = 0; k < tracks.size(); ++k) {
    if (!points.Set(k, noise, max_chi2, blocks)) continue;
    const auto inverse = information.Eliminate(blocks);
    if (inverse) depths.Add(k, blocks, *inverse, reconstruction.points[k].z());
  }
  const std::vector<LineFit> fits = EvaluateLines(tracks, reconstruction, kChi2TwoDof99);
  for (std::size_t k = 0; k < fits.size(); ++k) {
    if (fits[k].inlier) EliminateLine(tracks, reconstruction, k, line_noise, information);
  }
  auto poses = InvertWithScaleHeld(information.LowerTriangle(), reconstruction);
  if (!poses) return std::nullopt;
  ReconstructionCovariance result;
  result.relative_depth_sigmas = RelativeDepthSigmas(tracks.size(), std::move(depths), *poses);
  result.poses = std::move(*poses);
  return result;
}

PoseAccuracy AccuracyOf(const Reconstruction& reconstruction,
                        const ReconstructionCovariance& covariance,
                        int view) {
  const auto row = static_cast<Eigen::Index>(6 * view);
  const Rigid3& pose = reconstruction.cam_from_reference[static_cast<std::size_t>(view)];
  const double length = pose.translation.norm();
  const Eigen::Vector3d t = pose.translation / length;
  const Eigen::Matrix3d across = (Eigen::Matrix3d::Identity() - t * t.transpose()) / length;
  // exp([w, v]) T moves the centre by -R^T v, so that only the shift turns its direction.
  return {LargestSigma(covariance.poses.block<3, 3>(row, row)),
          LargestSigma(across * covariance.poses.block<3, 3>(row + 3, row + 3) * across)};
}

}  // namespace plumbline

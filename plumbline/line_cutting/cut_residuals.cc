// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/line_cutting/cut_residuals.h"

#include "plumbline/base/error.h"

#include <cmath>

#include <Eigen/LU>

namespace plumbline {
namespace {

using Eigen::Matrix2d;
using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

// Cut points nearer to each other than this are one point: their 2 x 2 covariance is singular in
// double precision.
constexpr double kMinRatioGap = 1e-4;

Matrix3d CovarianceByRatio(const CuttableLine& line, double ratio) {
  return -2 * (1 - ratio) * line.start_covariance + 2 * ratio * line.end_covariance;
}

// The shares of the start and of the end of the measured segment in the residual at a ratio, and
// their derivatives by the ratio.
struct ImageShares {
  Vector2d share, by_ratio;
};
ImageShares SharesAt(const CuttableLine& line, double ratio) {
  const double z0 = line.segment_in_cam.start.z();
  const double z1 = line.segment_in_cam.end.z();
  const double z = (1 - ratio) * z0 + ratio * z1;
  const double end = ratio * z1 / z;
  const double slope = z0 * z1 / (z * z);
  return {{1 - end, end}, {-slope, slope}};
}

void SetIndependent(const CuttableLine& line,
                    const std::array<CutResidual, 2>& points,
                    const std::array<double, 2>& ratios,
                    CutResiduals& out) {
  for (int k = 0; k < 2; ++k) {
    const auto i = static_cast<std::size_t>(k);
    const CutResidual& p = points[i];
    const Vector3d sigma_g = InterpolatedCovariance(line, ratios[i]) * p.gradient;
    const double variance = p.gradient.dot(sigma_g) + line.sigma_px * line.sigma_px;
    const double slope = 2 * p.gradient_by_ratio.dot(sigma_g) +
                         p.gradient.dot(CovarianceByRatio(line, ratios[i]) * p.gradient);
    out.weight(k, k) = 1 / variance;
    out.weight_by_ratio[i](k, k) = -slope / (variance * variance);
  }
}

void SetPrinted(const CuttableLine& line,
                const std::array<CutResidual, 2>& points,
                const std::array<double, 2>& ratios,
                CutResiduals& out) {
  for (int k = 0; k < 2; ++k) {
    const auto i = static_cast<std::size_t>(k);
    const CutResidual& p = points[i];
    const Vector3d omega_g = InterpolatedCovariance(line, ratios[i]).inverse() * p.gradient;
    out.weight(k, k) = p.gradient.dot(omega_g);
    out.weight_by_ratio[i](k, k) = 2 * p.gradient_by_ratio.dot(omega_g) -
                                   omega_g.dot(CovarianceByRatio(line, ratios[i]) * omega_g);
  }
}

// Computes the covariance of the two residuals and its derivatives by the two ratios.
void CovarianceOfResiduals(const CuttableLine& line,
                           const std::array<CutResidual, 2>& points,
                           const std::array<double, 2>& ratios,
                           Matrix2d& covariance,
                           std::array<Matrix2d, 2>& by_ratio) {
  // Residual k = a_k . e_start + b_k . e_end + shares_k . e_image.
  std::array<Vector3d, 2> a, b, da, db;
  std::array<ImageShares, 2> shares;
  for (std::size_t k = 0; k < 2; ++k) {
    const CutResidual& p = points[k];
    a[k] = (1 - ratios[k]) * p.gradient;
    b[k] = ratios[k] * p.gradient;
    da[k] = (1 - ratios[k]) * p.gradient_by_ratio - p.gradient;
    db[k] = ratios[k] * p.gradient_by_ratio + p.gradient;
    shares[k] = SharesAt(line, ratios[k]);
  }
  const double image = line.sigma_px * line.sigma_px;
  const auto cov = [&](const Vector3d& a1,
                       const Vector3d& b1,
                       const Vector2d& s1,
                       const Vector3d& a2,
                       const Vector3d& b2,
                       const Vector2d& s2) {
    return a1.dot(line.start_covariance * a2) + b1.dot(line.end_covariance * b2) +
           image * s1.dot(s2);
  };
  for (std::size_t i = 0; i < 2; ++i) {
    for (std::size_t k = 0; k < 2; ++k) {
      const auto row = static_cast<int>(i), column = static_cast<int>(k);
      covariance(row, column) = cov(a[i], b[i], shares[i].share, a[k], b[k], shares[k].share);
      const double slope = cov(da[i], db[i], shares[i].by_ratio, a[k], b[k], shares[k].share);
      by_ratio[i](row, column) += slope;
      by_ratio[i](column, row) += slope;
    }
  }
}

void SetCorrelated(const CuttableLine& line,
                   const std::array<CutResidual, 2>& points,
                   const std::array<double, 2>& ratios,
                   CutResiduals& out) {
  Matrix2d covariance;
  std::array<Matrix2d, 2> by_ratio{Matrix2d::Zero(), Matrix2d::Zero()};
  CovarianceOfResiduals(line, points, ratios, covariance, by_ratio);
  if (std::abs(ratios[0] - ratios[1]) < kMinRatioGap) {
    for (int k = 0; k < 2; ++k) {
      const double variance = covariance(k, k);
      out.weight(k, k) = 0.5 / variance;
      const auto i = static_cast<std::size_t>(k);
      out.weight_by_ratio[i](k, k) = -0.5 * by_ratio[i](k, k) / (variance * variance);
    }
    return;
  }
  out.weight = covariance.inverse();
  for (std::size_t k = 0; k < 2; ++k) {
    out.weight_by_ratio[k] = -out.weight * by_ratio[k] * out.weight;
  }
}

}  // namespace

CutResidual EvaluateCutPoint(const RectifiedCamera& camera,
                             const CuttableLine& line,
                             double ratio) {
  const Vector3d& l = line.image_line;
  // r = q . X / z, with q the normal of the plane through the camera and the image line.
  const Vector3d q(
      l.x() * camera.fx, l.y() * camera.fy, l.x() * camera.cx + l.y() * camera.cy + l.z());
  const Vector3d x = PointAt(line.segment_in_cam, ratio);
  const Vector3d direction = line.segment_in_cam.end - line.segment_in_cam.start;
  const double z = x.z();
  CutResidual out;
  out.r = q.dot(x) / z;
  out.gradient = q / z;
  out.gradient.z() -= out.r / z;
  out.gradient_by_ratio = -out.gradient * (direction.z() / z);
  out.gradient_by_ratio.z() -= out.gradient.dot(direction) / z;
  out.pose_row << x.cross(out.gradient), out.gradient;
  out.pose_row_by_ratio << direction.cross(out.gradient) + x.cross(out.gradient_by_ratio),
      out.gradient_by_ratio;
  return out;
}

Matrix3d InterpolatedCovariance(const CuttableLine& line, double ratio) {
  return (1 - ratio) * (1 - ratio) * line.start_covariance + ratio * ratio * line.end_covariance;
}

CutResiduals EvaluateCut(const RectifiedCamera& camera,
                         const CuttableLine& line,
                         const LineCut& cut,
                         CuttingInformation information) {
  const std::array<double, 2> ratios{cut.first, cut.second};
  std::array<CutResidual, 2> points;
  CutResiduals out;
  for (std::size_t k = 0; k < 2; ++k) {
    points[k] = EvaluateCutPoint(camera, line, ratios[k]);
    out.rows.row(static_cast<int>(k)) = points[k].pose_row.transpose();
    out.rows_by_ratio.row(static_cast<int>(k)) = points[k].pose_row_by_ratio.transpose();
    out.weight_by_ratio[k].setZero();
  }
  out.weight.setZero();
  switch (information) {
    case CuttingInformation::kIndependent:
      SetIndependent(line, points, ratios, out);
      break;
    case CuttingInformation::kPrinted:
      SetPrinted(line, points, ratios, out);
      break;
    case CuttingInformation::kCorrelated:
      SetCorrelated(line, points, ratios, out);
      break;
  }
  return out;
}

}  // namespace plumbline

// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/initialization/reconstruction.h"

#include "plumbline/base/statistics.h"
#include "plumbline/geometry/triangulation.h"
#include "plumbline/optimization/bundle_adjustment.h"
#include "plumbline/optimization/residuals.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace plumbline {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

double PointChi2(const Rigid3& pose, const Eigen::Vector3d& point, const PointMeasurement& seen) {
  const Eigen::Vector3d in_cam = pose * point;
  if (!(in_cam.z() > 0)) return kInfinity;
  return (in_cam.hnormalized() - seen.px).squaredNorm() / (seen.sigma_px * seen.sigma_px);
}

double LineChi2(const Rigid3& pose, const OrthonormalLine& line, const LineMeasurement& seen) {
  const auto residual = EvaluateLine(kIdealCamera, pose, line, seen);
  return residual ? residual->r.squaredNorm() : kInfinity;
}

bool IsSeen(const FeatureTracks& tracks, std::size_t k) {
  return std::any_of(tracks.views.begin(), tracks.views.end(), [&](const ViewPoints& view) {
    return view.Has(k);
  });
}

std::optional<PluckerLine> Triangulate(const FeatureTracks& tracks,
                                       const Reconstruction& reconstruction,
                                       std::size_t k) {
  // All residuals are allowed here, because the joint adjustment of all lines detects disagreements
  // of the views.
  constexpr double kAnyResidual = 1e9;
  std::vector<LineView> views;
  VisitViews(tracks.lines, k, [&](std::size_t i, const ViewLines& view) {
    views.push_back({reconstruction.Pose(i), view.segments[k], view.sigmas[k]});
  });
  const auto line =
      TriangulateLine(kIdealCamera, views, {.min_angle = 1e-3, .max_residual_sigma = kAnyResidual});
  if (!line) return std::nullopt;
  return line->line;
}

}  // namespace

PointMeasurement MeasurementOf(const ViewPoints& view, std::size_t k) {
  return {view.points[k], view.sigmas[k], std::nullopt};
}

LineMeasurement MeasurementOf(const ViewLines& view, std::size_t k, double noise) {
  const double sigma = noise * view.sigmas[k];
  return {view.segments[k], sigma * sigma * Eigen::Matrix2d::Identity()};
}

void TriangulatePoints(const FeatureTracks& tracks, Reconstruction& reconstruction) {
  for (std::size_t k = 0; k < tracks.size(); ++k) {
    std::vector<PointView> views;
    VisitViews(tracks, k, [&](std::size_t i, const ViewPoints& view) {
      views.push_back({reconstruction.Pose(i), view.points[k], view.sigmas[k], std::nullopt});
    });
    const auto point = TriangulatePoint(kIdealCamera, views, {.min_angle = 0});
    if (point) reconstruction.points[k] = point->position;
  }
}

void TriangulateLines(const FeatureTracks& tracks, Reconstruction& reconstruction) {
  reconstruction.lines.clear();
  for (std::size_t k = 0; k < tracks.lines.size(); ++k) {
    reconstruction.lines.push_back(Triangulate(tracks, reconstruction, k));
  }
}

ReprojectionFit EvaluatePoints(const FeatureTracks& tracks,
                               const Reconstruction& reconstruction,
                               double max_chi2) {
  ReprojectionFit fit;
  int parameters = static_cast<int>(6 * tracks.views.size()) - 1;
  for (std::size_t k = 0; k < tracks.size(); ++k) {
    if (!IsSeen(tracks, k)) continue;
    parameters += 3;
    VisitViews(tracks, k, [&](std::size_t i, const ViewPoints& view) {
      const double chi2 =
          reconstruction.is_known[k]
              ? PointChi2(reconstruction.Pose(i), reconstruction.points[k], MeasurementOf(view, k))
              : kInfinity;
      fit.cost += std::min(chi2, max_chi2);
      ++fit.measurements;
      fit.inliers += chi2 < max_chi2 ? 1 : 0;
    });
  }
  const double free = std::max(1, 2 * fit.measurements - parameters);
  fit.noise = std::sqrt(fit.cost / free);
  return fit;
}

std::vector<LineFit> EvaluateLines(const FeatureTracks& tracks,
                                   const Reconstruction& reconstruction,
                                   double max_chi2) {
  std::vector<LineFit> fits(reconstruction.lines.size());
  for (std::size_t k = 0; k < fits.size(); ++k) {
    LineFit& fit = fits[k];
    const auto& place = reconstruction.lines[k];
    const auto line = place ? ToOrthonormal(*place) : OrthonormalLine{};
    fit.inlier = place.has_value();
    fit.freedom = -4;
    VisitViews(tracks.lines, k, [&](std::size_t i, const ViewLines& view) {
      const double chi2 =
          place ? LineChi2(reconstruction.Pose(i), line, MeasurementOf(view, k)) : kInfinity;
      fit.chi2 += chi2;
      fit.cost += std::min(chi2, max_chi2);
      fit.inlier = fit.inlier && chi2 < max_chi2;
      fit.freedom += 2;
    });
  }
  return fits;
}

Reconstruction BundleAdjust(const FeatureTracks& tracks,
                            Reconstruction reconstruction,
                            int max_iterations) {
  BaProblem problem;
  problem.camera = kIdealCamera;
  problem.poses.push_back({Rigid3{}, true});
  for (const Rigid3& pose : reconstruction.cam_from_reference) {
    problem.poses.push_back({pose, false});
  }
  std::vector<std::size_t> points;
  for (std::size_t k = 0; k < tracks.size(); ++k) {
    if (!reconstruction.is_known[k] || !IsSeen(tracks, k)) continue;
    problem.points.push_back(reconstruction.points[k]);
    VisitViews(tracks, k, [&](std::size_t i, const ViewPoints& view) {
      problem.point_observations.push_back(
          {static_cast<int>(i), static_cast<int>(points.size()), MeasurementOf(view, k)});
    });
    points.push_back(k);
  }
  std::vector<std::size_t> lines;
  for (std::size_t k = 0; k < reconstruction.lines.size(); ++k) {
    if (!reconstruction.lines[k]) continue;
    problem.lines.push_back(ToOrthonormal(*reconstruction.lines[k]));
    VisitViews(tracks.lines, k, [&](std::size_t i, const ViewLines& view) {
      problem.line_observations.push_back(
          {static_cast<int>(i), static_cast<int>(lines.size()), MeasurementOf(view, k)});
    });
    lines.push_back(k);
  }
  const BaResult result = SolveLocalBa(
      problem, {.rounds = 4, .max_iterations = max_iterations, .rejection_tolerance = 1e-2});
  for (std::size_t i = 0; i < reconstruction.cam_from_reference.size(); ++i) {
    reconstruction.cam_from_reference[i] = result.poses[i + 1];
  }
  for (std::size_t j = 0; j < points.size(); ++j) {
    reconstruction.points[points[j]] = result.points[j];
  }
  for (std::size_t j = 0; j < lines.size(); ++j) {
    reconstruction.lines[lines[j]] = ToPlucker(result.lines[j]);
  }
  return reconstruction;
}

void ScaleToMedianDepth(Reconstruction& reconstruction) {
  std::vector<double> depths;
  for (std::size_t k = 0; k < reconstruction.points.size(); ++k) {
    if (reconstruction.is_known[k]) depths.push_back(reconstruction.points[k].z());
  }
  const double median = UpperMedian(std::move(depths));
  if (!(median > 0)) return;
  for (Rigid3& pose : reconstruction.cam_from_reference) pose.translation /= median;
  for (Eigen::Vector3d& point : reconstruction.points) point /= median;
}

}  // namespace plumbline

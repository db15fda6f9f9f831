// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/initialization/candidate_models.h"

#include "plumbline/base/elementary.h"
#include "plumbline/base/statistics.h"
#include "plumbline/geometry/se3.h"
#include "plumbline/geometry/symmetric_matrix.h"
#include "plumbline/initialization/reconstruction_covariance.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace plumbline {
namespace {

// Angle by which the best model's direction is moved to either side, to find other minima.
constexpr double kProbe = 2 * kSameDirection;

// Returns the noise of the lines of a model, in units of the standard deviation assumed. It follows
// from the median of their squared errors over their degrees of freedom.
double LineNoiseOf(const std::vector<LineFit>& fits) {
  constexpr double kMedianOfChi2 = 0.839;  // for four degrees of freedom, divided by four
  std::vector<double> chi2;
  for (const LineFit& fit : fits) {
    if (fit.freedom > 0) chi2.push_back(fit.chi2 / fit.freedom);
  }
  return chi2.empty() ? 1 : std::sqrt(UpperMedian(std::move(chi2)) / kMedianOfChi2);
}

// Returns the best model, moved to either side along the direction least determined by its points
// and lines, until the direction of the newest translation is off by kProbe. All other poses follow
// by the covariance. These models are the ends of a valley of the cost, which may have another
// minimum there.
std::vector<Reconstruction> Probes(const FeatureTracks& tracks, const Reconstruction& best) {
  const auto covariance = ComputeCovariance(tracks, best, 1, kChi2TwoDof99);
  if (!covariance) return {};
  const Rigid3& newest = best.cam_from_reference.back();
  const double length = newest.translation.norm();
  const Eigen::Matrix<double, 3, 2> across = BasisAcross(newest.translation / length);
  const Eigenpairs<2> spread =
      EigenpairsOf<2>(across.transpose() * covariance->poses.bottomRightCorner<3, 3>() * across);
  const Eigen::Vector3d weakest = across * spread.vectors.col(1);
  // The step of all poses for a unit step along the direction that is fixed least.
  const Eigen::VectorXd step = covariance->poses.rightCols<3>() * weakest / spread.values(1);
  std::vector<Reconstruction> probes;
  for (const double side : {-1.0, 1.0}) {
    Reconstruction moved = best;
    for (std::size_t i = 0; i < moved.cam_from_reference.size(); ++i) {
      const Vector6d shift =
          side * math::Tan(kProbe) * length * step.segment<6>(static_cast<Eigen::Index>(6 * i));
      Rigid3& pose = moved.cam_from_reference[i];
      pose = Rigid3{ExpSo3(shift.head<3>()), shift.tail<3>()} * pose;
    }
    TriangulatePoints(tracks, moved);
    probes.push_back(std::move(moved));
  }
  return probes;
}

void TriangulateAndAdjust(const FeatureTracks& tracks, CandidateModel& model) {
  TriangulateLines(tracks, model.reconstruction);
  AdjustModel(tracks, model);
}

// Adds to the cost of models that of the lines that are inliers of at least one model.
void CountLines(const FeatureTracks& tracks, std::vector<CandidateModel>& models) {
  std::vector<std::vector<LineFit>> fits;
  std::vector<bool> counts(tracks.lines.size(), false);
  for (const CandidateModel& model : models) {
    fits.push_back(EvaluateLines(tracks, model.reconstruction, kChi2TwoDof99));
    for (std::size_t k = 0; k < counts.size(); ++k) counts[k] = counts[k] || fits.back()[k].inlier;
  }
  for (std::size_t j = 0; j < models.size(); ++j) {
    CandidateModel& model = models[j];
    model.cost = model.fit.cost;
    model.lines = 0;
    double chi2 = 0;
    int freedom = 0;
    for (std::size_t k = 0; k < counts.size(); ++k) {
      if (counts[k]) model.cost += fits[j][k].cost;
      if (!fits[j][k].inlier) continue;
      ++model.lines;
      chi2 += fits[j][k].chi2;
      freedom += fits[j][k].freedom;
    }
    if (freedom > 0) model.line_noise = std::sqrt(chi2 / freedom);
  }
  SortByCost(models);
}

}  // namespace

bool IsSameMotion(const Rigid3& a, const Rigid3& b) {
  const Eigen::Vector3d centre_a = Inverse(a).translation;
  const Eigen::Vector3d centre_b = Inverse(b).translation;
  const double angle = math::Atan2(centre_a.cross(centre_b).norm(), centre_a.dot(centre_b));
  return AngularDistance(a.rotation, b.rotation) < kSameRotation && angle < kSameDirection;
}

void InsertModel(CandidateModel model, std::vector<CandidateModel>& models) {
  const auto same = std::find_if(models.begin(), models.end(), [&](const CandidateModel& other) {
    return IsSameMotion(other.reconstruction.cam_from_reference.back(),
                        model.reconstruction.cam_from_reference.back());
  });
  if (same == models.end()) {
    models.push_back(std::move(model));
  } else if (model.cost < same->cost) {
    *same = std::move(model);
  }
}

void SortByCost(std::vector<CandidateModel>& models) {
  std::stable_sort(
      models.begin(), models.end(), [](const auto& a, const auto& b) { return a.cost < b.cost; });
}

void AdjustModel(const FeatureTracks& tracks, CandidateModel& model) {
  constexpr int kIterations = 6;
  model.reconstruction = BundleAdjust(tracks, std::move(model.reconstruction), kIterations);
  model.fit = EvaluatePoints(tracks, model.reconstruction, kChi2TwoDof99);
  model.cost = model.fit.cost;
}

std::vector<CandidateModel> AdjustWithLines(FeatureTracks& tracks,
                                            std::vector<CandidateModel> models,
                                            double min_noise) {
  Reconstruction& best = models.front().reconstruction;
  TriangulateLines(tracks, best);
  const double noise = LineNoiseOf(EvaluateLines(tracks, best, kChi2TwoDof99));
  ScaleSigmas(std::max(min_noise, noise), tracks.lines);
  for (CandidateModel& model : models) TriangulateAndAdjust(tracks, model);
  CountLines(tracks, models);
  for (Reconstruction& probe : Probes(tracks, models.front().reconstruction)) {
    models.push_back({std::move(probe), {}});
    TriangulateAndAdjust(tracks, models.back());
  }
  CountLines(tracks, models);
  std::vector<CandidateModel> distinct;
  for (CandidateModel& model : models) InsertModel(std::move(model), distinct);
  return distinct;
}

}  // namespace plumbline

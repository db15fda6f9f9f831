// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/initialization/line_evidence.h"

#include "plumbline/base/chi2.h"
#include "plumbline/base/elementary.h"
#include "plumbline/base/median.h"
#include "plumbline/geometry/basis_across.h"
#include "plumbline/geometry/triangulation.h"
#include "plumbline/initialization/window_covariance.h"
#include "plumbline/initialization/window_lines.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <Eigen/Eigenvalues>

namespace plumbline {
namespace {

// How far the best explanation's direction is moved to either side, to find other minima.
constexpr double kProbe = 2 * kSameDirection;

// The noise of the lines of a solution, in units of the standard deviation that they are said to
// have. It is told by the median of their squared errors over their degrees of freedom.
double LineNoiseOf(const std::vector<LineFit>& fits) {
  constexpr double kMedianOfChi2 = 0.839;  // of four degrees of freedom, over four
  std::vector<double> chi2;
  for (const LineFit& fit : fits) {
    if (fit.freedom > 0) chi2.push_back(fit.chi2 / fit.freedom);
  }
  return chi2.empty() ? 1 : std::sqrt(UpperMedian(std::move(chi2)) / kMedianOfChi2);
}

// The points where all rays of given poses meet.
void TriangulatePoints(const WindowTracks& tracks, WindowSolution& solution) {
  for (std::size_t k = 0; k < tracks.size(); ++k) {
    std::vector<PointView> views{
        {Rigid3{}, tracks.reference.points[k], tracks.reference.sigmas[k], std::nullopt}};
    for (std::size_t i = 0; i < tracks.views.size(); ++i) {
      const TrackedPoints& view = tracks.views[i];
      if (!view.Has(k)) continue;
      views.push_back(
          {solution.cam_from_reference[i], view.points[k], view.sigmas[k], std::nullopt});
    }
    const auto point = TriangulatePoint(kIdealCamera, views, {.min_parallax = 0});
    if (point) solution.points[k] = point->point.position;
  }
}

// An explanation moved along what its points and lines know least, until the direction of the
// newest translation is `angle` off, to either side; all else follows as the covariance has it.
// These are ends of a valley of the cost, where another minimum may be.
std::vector<WindowSolution> Probes(const WindowTracks& tracks,
                                   const Explanation& explanation,
                                   double angle) {
  const WindowSolution& solution = explanation.solution;
  const auto covariance = ComputeWindowCovariance(tracks, solution, 1, kChi2TwoDof99);
  if (!covariance) return {};
  const Rigid3& newest = solution.cam_from_reference.back();
  const double length = newest.translation.norm();
  const Eigen::Matrix<double, 3, 2> across = BasisAcross(newest.translation / length);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> spread(
      across.transpose() * covariance->poses.bottomRightCorner<3, 3>() * across);
  const Eigen::Vector3d weakest = across * spread.eigenvectors().col(1);
  // How all poses move with a unit step along what is known least.
  const Eigen::VectorXd step = covariance->poses.rightCols<3>() * weakest / spread.eigenvalues()(1);
  std::vector<WindowSolution> probes;
  for (const double side : {-1.0, 1.0}) {
    WindowSolution moved = solution;
    for (std::size_t i = 0; i < moved.cam_from_reference.size(); ++i) {
      const Vector6d shift =
          side * math::Tan(angle) * length * step.segment<6>(static_cast<Eigen::Index>(6 * i));
      Rigid3& pose = moved.cam_from_reference[i];
      pose = Rigid3{ExpSo3(shift.head<3>()), shift.tail<3>()} * pose;
    }
    TriangulatePoints(tracks, moved);
    probes.push_back(std::move(moved));
  }
  return probes;
}

void AdjustWithLines(const WindowTracks& tracks, Explanation& e) {
  e.solution.lines = TriangulateLines(tracks, e.solution);
  AdjustExplanation(tracks, e);
}

// Adds to the cost of explanations that of the lines which fit at least one of them.
void CountLines(const WindowTracks& tracks, std::vector<Explanation>& explanations) {
  std::vector<std::vector<LineFit>> fits;
  std::vector<bool> counts(tracks.lines.size(), false);
  for (const Explanation& e : explanations) {
    fits.push_back(EvaluateLines(tracks, e.solution, kChi2TwoDof99));
    for (std::size_t k = 0; k < counts.size(); ++k) counts[k] = counts[k] || fits.back()[k].fits;
  }
  for (std::size_t j = 0; j < explanations.size(); ++j) {
    Explanation& e = explanations[j];
    e.cost = e.fit.cost;
    e.lines = 0;
    double chi2 = 0;
    int freedom = 0;
    for (std::size_t k = 0; k < counts.size(); ++k) {
      if (counts[k]) e.cost += fits[j][k].cost;
      if (!fits[j][k].fits) continue;
      ++e.lines;
      chi2 += fits[j][k].chi2;
      freedom += fits[j][k].freedom;
    }
    if (freedom > 0) e.line_noise = std::sqrt(chi2 / freedom);
  }
  SortByCost(explanations);
}

}  // namespace

std::vector<Explanation> ExplainWithLines(WindowTracks& tracks,
                                          std::vector<Explanation> explanations,
                                          double min_noise) {
  WindowSolution& best = explanations.front().solution;
  best.lines = TriangulateLines(tracks, best);
  const double noise = LineNoiseOf(EvaluateLines(tracks, best, kChi2TwoDof99));
  ScaleSigmas(std::max(min_noise, noise), tracks.lines);
  for (Explanation& e : explanations) AdjustWithLines(tracks, e);
  CountLines(tracks, explanations);
  for (WindowSolution& probe : Probes(tracks, explanations.front(), kProbe)) {
    Explanation e{std::move(probe), {}};
    AdjustWithLines(tracks, e);
    explanations.push_back(std::move(e));
  }
  CountLines(tracks, explanations);
  std::vector<Explanation> distinct;
  for (Explanation& e : explanations) InsertExplanation(std::move(e), distinct);
  return distinct;
}

}  // namespace plumbline

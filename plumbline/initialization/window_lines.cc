// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/initialization/window_lines.h"

#include "plumbline/base/chi2.h"
#include "plumbline/geometry/line_triangulation.h"
#include "plumbline/optimization/residuals.h"

#include <algorithm>
#include <limits>
#include <optional>

namespace plumbline {
namespace {

double Chi2(const Rigid3& pose, const OrthonormalLine& line, const LineMeasurement& measured) {
  const auto residual = EvaluateLine(kIdealCamera, pose, line, measured);
  return residual ? residual->r.squaredNorm() : std::numeric_limits<double>::infinity();
}

std::optional<PluckerLine> Triangulate(const WindowTracks& tracks,
                                       const WindowSolution& solution,
                                       std::size_t k) {
  // What the views disagree about is found by adjustment, of all lines together.
  constexpr double kAnyResidual = 1e9;
  const TrackedLines& reference = tracks.lines.reference;
  std::vector<LineView> views{{Rigid3{}, reference.segments[k], reference.sigmas[k]}};
  for (std::size_t i = 0; i < tracks.lines.views.size(); ++i) {
    const TrackedLines& view = tracks.lines.views[i];
    if (!view.Has(k)) continue;
    views.push_back({solution.cam_from_reference[i], view.segments[k], view.sigmas[k]});
  }
  const auto line = TriangulateLine(
      kIdealCamera, views, {.min_plane_angle = 1e-3, .max_residual_sigma = kAnyResidual});
  if (!line) return std::nullopt;
  return line->estimate.line;
}

}  // namespace

LineMeasurement MeasurementOf(const TrackedLines& view, std::size_t k, double noise) {
  const double sigma = noise * view.sigmas[k];
  return {view.segments[k], sigma * sigma * Eigen::Matrix2d::Identity()};
}

std::vector<std::optional<PluckerLine>> TriangulateLines(const WindowTracks& tracks,
                                                         const WindowSolution& solution) {
  std::vector<std::optional<PluckerLine>> lines;
  for (std::size_t k = 0; k < tracks.lines.size(); ++k) {
    lines.push_back(Triangulate(tracks, solution, k));
  }
  return lines;
}

std::vector<LineFit> EvaluateLines(const WindowTracks& tracks,
                                   const WindowSolution& solution,
                                   double max_chi2) {
  std::vector<LineFit> fits(solution.lines.size());
  for (std::size_t k = 0; k < fits.size(); ++k) {
    LineFit& fit = fits[k];
    fit.freedom = -4;
    fit.fits = solution.lines[k].has_value();
    const auto line = fit.fits ? ToOrthonormal(*solution.lines[k]) : OrthonormalLine{};
    const auto add = [&](const Rigid3& pose, const TrackedLines& view) {
      const double chi2 = solution.lines[k] ? Chi2(pose, line, MeasurementOf(view, k))
                                            : std::numeric_limits<double>::infinity();
      fit.chi2 += chi2;
      fit.cost += std::min(chi2, max_chi2);
      fit.fits = fit.fits && chi2 < max_chi2;
      fit.freedom += 2;
    };
    add({}, tracks.lines.reference);
    for (std::size_t i = 0; i < tracks.lines.views.size(); ++i) {
      if (tracks.lines.views[i].Has(k)) add(solution.cam_from_reference[i], tracks.lines.views[i]);
    }
  }
  return fits;
}

std::vector<std::size_t> LinesThatFit(const WindowTracks& tracks, const WindowSolution& solution) {
  const std::vector<LineFit> fits = EvaluateLines(tracks, solution, kChi2TwoDof99);
  std::vector<std::size_t> fitting;
  for (std::size_t k = 0; k < fits.size(); ++k) {
    if (fits[k].fits) fitting.push_back(k);
  }
  return fitting;
}

}  // namespace plumbline

// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/initialization/window_adjustment.h"

#include "plumbline/base/median.h"
#include "plumbline/initialization/window_lines.h"
#include "plumbline/optimization/local_ba.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace plumbline {
namespace {

double Chi2(const Rigid3& pose,
            const Eigen::Vector3d& point,
            const Eigen::Vector2d& seen,
            double s) {
  const Eigen::Vector3d in_cam = pose * point;
  if (!(in_cam.z() > 0)) return std::numeric_limits<double>::infinity();
  return (in_cam.hnormalized() - seen).squaredNorm() / (s * s);
}

void AddObservation(const TrackedPoints& view, std::size_t k, int pose, int point, BaProblem& out) {
  out.point_observations.push_back({pose, point, {view.points[k], view.sigmas[k], std::nullopt}});
}

// All lines that have a place; returns which.
std::vector<std::size_t> AddLines(const WindowTracks& tracks,
                                  const WindowSolution& solution,
                                  BaProblem& out) {
  std::vector<std::size_t> added;
  for (std::size_t k = 0; k < solution.lines.size(); ++k) {
    if (!solution.lines[k]) continue;
    const int line = static_cast<int>(added.size());
    added.push_back(k);
    out.lines.push_back(ToOrthonormal(*solution.lines[k]));
    out.line_observations.push_back({0, line, MeasurementOf(tracks.lines.reference, k)});
    for (std::size_t i = 0; i < tracks.lines.views.size(); ++i) {
      const TrackedLines& view = tracks.lines.views[i];
      if (view.Has(k)) {
        out.line_observations.push_back({static_cast<int>(i) + 1, line, MeasurementOf(view, k)});
      }
    }
  }
  return added;
}

bool IsSeen(const WindowTracks& tracks, std::size_t k) {
  return std::any_of(tracks.views.begin(), tracks.views.end(), [&](const TrackedPoints& view) {
    return view.Has(k);
  });
}

}  // namespace

WindowFit EvaluateWindow(const WindowTracks& tracks,
                         const WindowSolution& solution,
                         double max_chi2) {
  WindowFit fit;
  int parameters = static_cast<int>(6 * tracks.views.size()) - 1;
  const auto add = [&](double chi2) {
    fit.cost += std::min(chi2, max_chi2);
    ++fit.measurements;
    fit.inliers += chi2 < max_chi2 ? 1 : 0;
  };
  for (std::size_t k = 0; k < tracks.size(); ++k) {
    if (!IsSeen(tracks, k)) continue;
    parameters += 3;
    const bool known = solution.is_known[k];
    const auto chi2 = [&](const Rigid3& pose, const TrackedPoints& view) {
      return known ? Chi2(pose, solution.points[k], view.points[k], view.sigmas[k])
                   : std::numeric_limits<double>::infinity();
    };
    add(chi2({}, tracks.reference));
    for (std::size_t i = 0; i < tracks.views.size(); ++i) {
      if (tracks.views[i].Has(k)) add(chi2(solution.cam_from_reference[i], tracks.views[i]));
    }
  }
  const double free = std::max(1, 2 * fit.measurements - parameters);
  fit.noise = std::sqrt(fit.cost / free);
  return fit;
}

WindowSolution AdjustWindow(const WindowTracks& tracks,
                            const WindowSolution& solution,
                            int max_iterations) {
  BaProblem problem;
  problem.camera = kIdealCamera;
  problem.poses.push_back({Rigid3{}, true});
  for (const Rigid3& pose : solution.cam_from_reference) problem.poses.push_back({pose, false});
  std::vector<std::size_t> adjusted;
  for (std::size_t k = 0; k < tracks.size(); ++k) {
    if (!solution.is_known[k] || !IsSeen(tracks, k)) continue;
    const int point = static_cast<int>(adjusted.size());
    adjusted.push_back(k);
    problem.points.push_back(solution.points[k]);
    AddObservation(tracks.reference, k, 0, point, problem);
    for (std::size_t i = 0; i < tracks.views.size(); ++i) {
      if (tracks.views[i].Has(k)) {
        AddObservation(tracks.views[i], k, static_cast<int>(i) + 1, point, problem);
      }
    }
  }
  const std::vector<std::size_t> lines = AddLines(tracks, solution, problem);
  const BaResult result = SolveLocalBa(
      problem, {.rounds = 4, .max_iterations = max_iterations, .rejection_tolerance = 1e-2});
  WindowSolution adjusted_solution = solution;
  for (std::size_t i = 0; i < solution.cam_from_reference.size(); ++i) {
    adjusted_solution.cam_from_reference[i] = result.poses[i + 1];
  }
  for (std::size_t j = 0; j < adjusted.size(); ++j) {
    adjusted_solution.points[adjusted[j]] = result.points[j];
  }
  for (std::size_t j = 0; j < lines.size(); ++j) {
    adjusted_solution.lines[lines[j]] = ToPlucker(result.lines[j]);
  }
  return adjusted_solution;
}

void ScaleToMedianDepth(WindowSolution& solution) {
  std::vector<double> depths;
  for (std::size_t k = 0; k < solution.points.size(); ++k) {
    if (solution.is_known[k]) depths.push_back(solution.points[k].z());
  }
  const double median = UpperMedian(depths);
  if (!(median > 0)) return;
  for (Rigid3& pose : solution.cam_from_reference) pose.translation /= median;
  for (Eigen::Vector3d& point : solution.points) point /= median;
}

}  // namespace plumbline

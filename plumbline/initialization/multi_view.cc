// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/initialization/multi_view.h"

#include "plumbline/base/chi2.h"
#include "plumbline/base/elementary.h"
#include "plumbline/base/median.h"
#include "plumbline/base/parallel.h"
#include "plumbline/base/units.h"
#include "plumbline/geometry/basis_across.h"
#include "plumbline/initialization/line_evidence.h"
#include "plumbline/initialization/window_adjustment.h"
#include "plumbline/initialization/window_covariance.h"
#include "plumbline/initialization/window_explanation.h"
#include "plumbline/solvers/pose_refinement.h"
#include "plumbline/solvers/relative_pose.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace plumbline {
namespace {

// A hypothesis this much worse than the best before adjustment is not worth one.
constexpr double kHopeless = 2;
// Least noise of a fit, in units of the noise that the distances from the epipolar lines have: what
// these do not show is not less.
constexpr double kLeastNoise = 0.4;

std::vector<RayMatch> MatchesOfNewest(const WindowTracks& tracks) {
  std::vector<RayMatch> matches;
  const TrackedPoints& newest = tracks.views.back();
  for (std::size_t k = 0; k < tracks.size(); ++k) {
    if (!newest.Has(k)) continue;
    matches.push_back({tracks.reference.points[k],
                       newest.points[k],
                       tracks.reference.sigmas[k],
                       newest.sigmas[k]});
  }
  return matches;
}

// Angle between the rays to the newest and to the reference frame, of the median point.
double ParallaxDeg(const WindowTracks& tracks, const WindowSolution& solution) {
  const Eigen::Vector3d centre = Inverse(solution.cam_from_reference.back()).translation;
  std::vector<double> angles;
  for (std::size_t k = 0; k < tracks.size(); ++k) {
    if (!tracks.views.back().Has(k)) continue;
    const Eigen::Vector3d to_centre = solution.points[k] - centre;
    const Eigen::Vector3d& point = solution.points[k];
    angles.push_back(solution.is_known[k]
                         ? math::Atan2(point.cross(to_centre).norm(), point.dot(to_centre))
                         : 0);
  }
  return UpperMedian(std::move(angles)) / kDegree;
}

// What is done to each of several explanations is done to two at a time: a plane has two.
constexpr int kThreads = 2;

// All hypotheses carried through all frames.
std::vector<Explanation> Explain(const WindowTracks& tracks,
                                 const std::vector<WindowHypothesis>& hypotheses,
                                 const WindowDecisionOptions& options) {
  auto explained = ParallelMap<std::optional<Explanation>>(
      static_cast<int>(hypotheses.size()), kThreads, [&](int i) -> std::optional<Explanation> {
        const WindowHypothesis& hypothesis = hypotheses[static_cast<std::size_t>(i)];
        auto solution = FactorizeWindow(tracks, hypothesis, options.factorization);
        if (!solution) return std::nullopt;
        const WindowFit fit = EvaluateWindow(tracks, *solution, kChi2TwoDof99);
        return Explanation{std::move(*solution), fit, fit.cost};
      });
  std::vector<Explanation> explanations;
  for (auto& explanation : explained) {
    if (explanation) InsertExplanation(std::move(*explanation), explanations);
  }
  return explanations;
}

// Adjusts all that are worth it. The best first; of those that become the same, the best.
void AdjustAll(const WindowTracks& tracks, std::vector<Explanation>& explanations) {
  SortByCost(explanations);
  const double limit = kHopeless * explanations.front().cost;
  std::erase_if(explanations, [limit](const Explanation& e) { return e.cost > limit; });
  ParallelFor(static_cast<int>(explanations.size()), kThreads, [&](int i) {
    AdjustExplanation(tracks, explanations[static_cast<std::size_t>(i)]);
  });
  std::vector<Explanation> adjusted;
  for (Explanation& e : explanations) InsertExplanation(std::move(e), adjusted);
  explanations = std::move(adjusted);
  SortByCost(explanations);
}

// Noise of the matches, in units of the standard deviation that they are said to have: by the
// median distance from the epipolar lines, which has one degree of freedom.
double NoiseOf(const std::vector<RayMatch>& matches, const RelativePoseHypothesis& hypothesis) {
  constexpr double kMedianOfChi2 = 0.4549;
  std::vector<double> chi2;
  const Eigen::Matrix<double, 3, 2> basis = BasisAcross(hypothesis.b_from_a.translation);
  for (const RayMatch& match : matches) {
    const double distance = EvaluateSampson(hypothesis.b_from_a, basis, match).value;
    chi2.push_back(distance * distance);
  }
  return std::sqrt(UpperMedian(std::move(chi2)) / kMedianOfChi2);
}

// Median of the deviations of the depths of all points of the tracks; those without one count as
// unknown.
double MedianDepthSigma(const WindowCovariance& covariance) {
  std::vector<double> sigmas = covariance.relative_depth_sigmas;
  for (double& sigma : sigmas) {
    if (sigma < 0) sigma = std::numeric_limits<double>::infinity();
  }
  return UpperMedian(std::move(sigmas));
}

// Whether what is promised for a solution is good enough.
InitializationWait Accuracy(const WindowTracks& tracks,
                            const Explanation& explanation,
                            const WindowDecisionOptions& options) {
  const double noise = std::max(kLeastNoise, explanation.fit.noise);
  const auto covariance = ComputeWindowCovariance(tracks,
                                                  explanation.solution,
                                                  noise,
                                                  kChi2TwoDof99 / (noise * noise),
                                                  std::max(kLeastNoise, explanation.line_noise));
  if (!covariance) return InitializationWait::kTooLittleParallax;
  const double depth = MedianDepthSigma(*covariance);
  const int newest = static_cast<int>(tracks.views.size()) - 1;
  const PoseAccuracy pose = AccuracyOf(explanation.solution, *covariance, newest);
  // Depths that are not known at all: there is no parallax.
  constexpr double kUnknown = 0.3;
  if (!(depth < kUnknown)) return InitializationWait::kTooLittleParallax;
  if (depth > options.max_depth || pose.rotation > options.max_rotation_deg * kDegree ||
      pose.direction > options.max_direction_deg * kDegree) {
    return InitializationWait::kInaccurate;
  }
  return InitializationWait::kNone;
}

// The best must be good and no other may come near. An explanation that is not out of the question
// must have had its chance as well: the wrong interpretation of a plane often shows more parallax
// and so seems to be known before the right one is.
InitializationWait Judge(const WindowTracks& tracks,
                         const std::vector<Explanation>& explanations,
                         const WindowDecisionOptions& options) {
  const Explanation& best = explanations.front();
  // Few points and no lines.
  if (static_cast<int>(tracks.views.back().CountSeen()) + best.lines < options.min_matches) {
    return InitializationWait::kTooFewMatches;
  }
  if (best.fit.inliers < options.min_inlier_share * best.fit.measurements) {
    return InitializationWait::kInaccurate;
  }
  if (ParallaxDeg(tracks, best.solution) < options.min_parallax_deg) {
    return InitializationWait::kTooLittleParallax;
  }
  for (const Explanation& e : explanations) {
    if (e.cost > kHopeless * best.cost) break;
    const InitializationWait accuracy = Accuracy(tracks, e, options);
    if (accuracy != InitializationWait::kNone) return accuracy;
  }
  if (explanations.size() > 1 && explanations[1].cost < best.cost * (1 + options.min_margin)) {
    return InitializationWait::kAmbiguous;
  }
  return InitializationWait::kNone;
}

std::vector<WindowSolution> Possible(const std::vector<Explanation>& explanations) {
  std::vector<WindowSolution> possible;
  for (const Explanation& e : explanations) {
    if (e.cost <= kHopeless * explanations.front().cost) possible.push_back(e.solution);
  }
  return possible;
}

WindowDecision Wait(InitializationWait reason) {
  WindowDecision decision;
  decision.wait = reason;
  return decision;
}

// Whether the points of the window before, which was sure of itself as well, see the newest frame
// where the solution has it: what two windows find by chance is not the same.
bool Confirms(const WindowTracks& tracks,
              const WindowHypothesis& before,
              const WindowSolution& solution) {
  const auto pose = PoseOfNewest(tracks, before);
  if (!pose) return false;
  return IsSame({{*pose}, {}, {}}, {{solution.cam_from_reference.back()}, {}, {}});
}

// Where points alone do not suffice and there are few; what many points leave open is not for lines
// to decide.
bool NeedsLines(const WindowTracks& tracks,
                InitializationWait wait,
                const WindowDecisionOptions& options) {
  return wait != InitializationWait::kNone && wait != InitializationWait::kTooLittleParallax &&
         tracks.lines.size() > 0 && static_cast<int>(tracks.size()) < options.many_points;
}

}  // namespace

void WindowMemory::Keep(const WindowTracks& tracks,
                        const std::vector<WindowSolution>& solutions,
                        bool sure) {
  Clear();
  sure_ = sure;
  for (const WindowSolution& solution : solutions) {
    Explanation kept{solution.cam_from_reference.back(), {}};
    for (std::size_t k = 0; k < tracks.size(); ++k) {
      if (!solution.is_known[k]) continue;
      kept.inverse_distances[tracks.features[k]] = 1 / solution.points[k].norm();
    }
    explanations_.push_back(std::move(kept));
  }
}

std::vector<WindowHypothesis> WindowMemory::HypothesesFor(const WindowTracks& tracks) const {
  std::vector<WindowHypothesis> hypotheses;
  for (const Explanation& kept : explanations_) {
    WindowHypothesis hypothesis{kept.newest_from_reference, {}};
    for (const int feature : tracks.features) {
      const auto found = kept.inverse_distances.find(feature);
      hypothesis.inverse_distances.push_back(found == kept.inverse_distances.end() ? 0
                                                                                   : found->second);
    }
    hypotheses.push_back(std::move(hypothesis));
  }
  return hypotheses;
}

WindowDecision DecideWindow(const WindowTracks& tracks,
                            const WindowDecisionOptions& options,
                            WindowMemory& memory,
                            Rng& rng) {
  const std::vector<RayMatch> matches = MatchesOfNewest(tracks);
  if (static_cast<int>(matches.size()) < options.min_points) {
    return Wait(InitializationWait::kTooFewMatches);
  }
  const auto hypotheses = EstimateRelativePoses(matches, options.relative_pose, rng);
  if (hypotheses.empty()) return Wait(InitializationWait::kInaccurate);
  const double noise = NoiseOf(matches, hypotheses.front());
  WindowTracks scaled = tracks;
  ScaleSigmas(std::max(options.min_noise, noise), scaled);
  std::vector<WindowHypothesis> starts = memory.HypothesesFor(scaled);
  for (const RelativePoseHypothesis& h : hypotheses) starts.push_back({h.b_from_a, {}});
  std::vector<Explanation> explanations = Explain(scaled, starts, options);
  if (explanations.empty()) return Wait(InitializationWait::kInaccurate);
  // Adjusted to points alone, two that lines tell apart may become one.
  std::vector<Explanation> with_lines = explanations;
  AdjustAll(scaled, explanations);
  WindowDecision decision;
  decision.wait = Judge(scaled, explanations, options);
  if (NeedsLines(scaled, decision.wait, options)) {
    with_lines.insert(with_lines.begin(), explanations.begin(), explanations.end());
    explanations = ExplainWithLines(scaled, std::move(with_lines), options.min_noise);
    decision.wait = Judge(scaled, explanations, options);
  }
  Explanation& best = explanations.front();
  decision.parallax_deg = ParallaxDeg(scaled, best.solution);
  const bool sure = decision.wait == InitializationWait::kNone;
  if (sure &&
      !(memory.sure() && Confirms(scaled, memory.HypothesesFor(scaled).front(), best.solution))) {
    decision.wait = InitializationWait::kInaccurate;
  }
  memory.Keep(scaled, Possible(explanations), sure);
  if (decision.wait != InitializationWait::kNone) return decision;
  ScaleToMedianDepth(best.solution);
  decision.solution = std::move(best.solution);
  return decision;
}

}  // namespace plumbline

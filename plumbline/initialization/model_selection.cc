// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/initialization/model_selection.h"

#include "plumbline/base/elementary.h"
#include "plumbline/base/ids.h"
#include "plumbline/base/parallel.h"
#include "plumbline/base/statistics.h"
#include "plumbline/base/units.h"
#include "plumbline/geometry/se3.h"
#include "plumbline/initialization/reconstruction_covariance.h"
#include "plumbline/solvers/pose_refinement.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace plumbline {
namespace {

// Fewest matches of points and lines between the newest frame and the reference, and of points.
constexpr int kMinMatches = 24;
constexpr std::size_t kMinPoints = 12;
constexpr double kMinParallaxDeg = 1.2;   // at the median point of the newest frame
constexpr double kMinInlierShare = 0.85;  // share of the matches of all views
// A model is chosen only if the chi2 of the next best model is larger by at least this part of the
// chi2 of the best one.
constexpr double kMinMargin = 0.5;
// Largest standard deviations that the covariance may promise: of the rotation of the newest pose,
// of the direction of the line between the centres, and of the depth of the median point, relative.
constexpr double kMaxRotation = 0.06 * kDegree;
constexpr double kMaxDirection = 0.7 * kDegree;
constexpr double kMaxDepth = 0.06;
// From this deviation on depths are not known at all: there is no parallax.
constexpr double kUnknownDepth = 0.3;
// Least noise of measurements that is assumed, relative to their stated deviation.
constexpr double kMinNoise = 0.25;
// Least noise of a fit, in units of the noise of the distances from the epipolar lines. A smaller
// noise is not believed unless these distances show it.
constexpr double kLeastNoise = 0.4;
// A model whose cost is this many times that of the best one before adjustment is not adjusted.
constexpr double kHopeless = 2;
// Deviation of the rotation of a model that is worth a comparison with a gyroscope's.
constexpr double kTurnSigma = 0.3 * kDegree;
// With at least this many points, lines are not used.
constexpr std::size_t kManyPoints = 200;
// The work for each of several models is done by two threads, since a plane gives two models.
constexpr int kThreads = 2;

// Returns the noise of the matches, in units of their stated standard deviation, from the median
// distance from the epipolar lines, which has one degree of freedom.
double NoiseOf(const std::vector<RayMatch>& matches, const Rigid3& b_from_a) {
  constexpr double kMedianOfChi2 = 0.4549;
  std::vector<double> chi2;
  const Eigen::Matrix<double, 3, 2> basis = BasisAcross(b_from_a.translation);
  for (const RayMatch& match : matches) {
    const double distance = EvaluateSampson(b_from_a, basis, match).value;
    chi2.push_back(distance * distance);
  }
  return std::sqrt(UpperMedian(std::move(chi2)) / kMedianOfChi2);
}

// Returns the models of all hypotheses that can be carried through all frames.
std::vector<CandidateModel> FactorizeAll(const FeatureTracks& tracks,
                                         const std::vector<MotionHypothesis>& hypotheses,
                                         const FactorizationOptions& options) {
  auto factorized = ParallelMap<std::optional<CandidateModel>>(
      static_cast<int>(hypotheses.size()), kThreads, [&](int i) -> std::optional<CandidateModel> {
        auto reconstruction = FactorizeTracks(tracks, hypotheses[Index(i)], options);
        if (!reconstruction) return std::nullopt;
        const ReprojectionFit fit = EvaluatePoints(tracks, *reconstruction, kChi2TwoDof99);
        return CandidateModel{std::move(*reconstruction), fit, fit.cost};
      });
  std::vector<CandidateModel> models;
  for (auto& model : factorized) {
    if (model) InsertModel(std::move(*model), models);
  }
  return models;
}

// Removes models that are too bad to be the right one. The best model must be the first.
void DropHopeless(std::vector<CandidateModel>& models) {
  const double limit = kHopeless * models.front().cost;
  std::erase_if(models, [limit](const CandidateModel& model) { return model.cost > limit; });
}

// Adjusts all models that are worth it, and puts the best first. Of models that become the same
// only the best stays.
void AdjustAll(const FeatureTracks& tracks, std::vector<CandidateModel>& models) {
  SortByCost(models);
  DropHopeless(models);
  ParallelFor(static_cast<int>(models.size()), kThreads, [&](int i) {
    AdjustModel(tracks, models[Index(i)]);
  });
  std::vector<CandidateModel> adjusted;
  for (CandidateModel& model : models) InsertModel(std::move(model), adjusted);
  models = std::move(adjusted);
  SortByCost(models);
}

// Returns the angle between the rays to the newest and to the reference frame, for the median
// point.
double ParallaxDeg(const FeatureTracks& tracks, const Reconstruction& reconstruction) {
  const Eigen::Vector3d centre = Inverse(reconstruction.cam_from_reference.back()).translation;
  std::vector<double> angles;
  for (std::size_t k = 0; k < tracks.size(); ++k) {
    if (!tracks.views.back().Has(k)) continue;
    const Eigen::Vector3d& point = reconstruction.points[k];
    const Eigen::Vector3d to_centre = point - centre;
    angles.push_back(reconstruction.is_known[k]
                         ? math::Atan2(point.cross(to_centre).norm(), point.dot(to_centre))
                         : 0);
  }
  return UpperMedian(std::move(angles)) / kDegree;
}

// Returns the median deviation of the depths of all points of the tracks. Points without a
// deviation count as unknown.
double MedianDepthSigma(const ReconstructionCovariance& covariance) {
  std::vector<double> sigmas = covariance.relative_depth_sigmas;
  for (double& sigma : sigmas) {
    if (sigma < 0) sigma = std::numeric_limits<double>::infinity();
  }
  return UpperMedian(std::move(sigmas));
}

// Tests whether the predicted accuracy of a model, by its covariance, is sufficient.
InitializationStatus TestAccuracy(const FeatureTracks& tracks, const CandidateModel& model) {
  const double noise = std::max(kLeastNoise, model.fit.noise);
  const auto covariance = ComputeCovariance(tracks,
                                            model.reconstruction,
                                            noise,
                                            kChi2TwoDof99 / (noise * noise),
                                            std::max(kLeastNoise, model.line_noise));
  if (!covariance) return InitializationStatus::kTooLittleParallax;
  const double depth = MedianDepthSigma(*covariance);
  if (!(depth < kUnknownDepth)) return InitializationStatus::kTooLittleParallax;
  const int newest = static_cast<int>(tracks.views.size()) - 1;
  const PoseAccuracy pose = AccuracyOf(model.reconstruction, *covariance, newest);
  const bool accurate =
      depth <= kMaxDepth && pose.rotation <= kMaxRotation && pose.direction <= kMaxDirection;
  return accurate ? InitializationStatus::kNone : InitializationStatus::kInaccurate;
}

// Decides about the models: the best must be good, and no other may come near. Every model that is
// not out of the question must be accurate, too, since the wrong interpretation of a plane often
// shows more parallax and so seems to be known before the right one is.
InitializationStatus Decide(const FeatureTracks& tracks,
                            const std::vector<CandidateModel>& models) {
  const CandidateModel& best = models.front();
  // The tracks have few points and few lines.
  if (static_cast<int>(tracks.views.back().CountSeen()) + best.lines < kMinMatches) {
    return InitializationStatus::kTooFewMatches;
  }
  if (best.fit.inliers < kMinInlierShare * best.fit.measurements) {
    return InitializationStatus::kInaccurate;
  }
  if (ParallaxDeg(tracks, best.reconstruction) < kMinParallaxDeg) {
    return InitializationStatus::kTooLittleParallax;
  }
  for (const CandidateModel& model : models) {
    if (model.cost > kHopeless * best.cost) break;
    const InitializationStatus accuracy = TestAccuracy(tracks, model);
    if (accuracy != InitializationStatus::kNone) return accuracy;
  }
  if (models.size() > 1 && models[1].cost < best.cost * (1 + kMinMargin)) {
    return InitializationStatus::kAmbiguous;
  }
  return InitializationStatus::kNone;
}

// Removes models whose rotations the gyroscope excludes (99.9 %), unless it excludes all.
void DropContradicted(const std::optional<MeasuredTurns>& turns,
                      std::vector<CandidateModel>& models) {
  if (!turns) return;
  constexpr double kDeviations = 3.1;
  const double mean = 3 * static_cast<double>(turns->of_views.size());
  const double limit = mean + kDeviations * std::sqrt(2 * mean) + kDeviations * kDeviations;
  const auto excluded = [&](const CandidateModel& model) {
    return TurnChi2(*turns, model.reconstruction) > limit;
  };
  if (std::all_of(models.begin(), models.end(), excluded)) return;
  std::erase_if(models, excluded);
}

// Returns true if lines are used: points alone do not suffice, and there are few of them. Lines do
// not decide an ambiguity left by many points.
bool NeedsLines(const FeatureTracks& tracks, InitializationStatus wait) {
  return wait != InitializationStatus::kNone && wait != InitializationStatus::kTooLittleParallax &&
         tracks.lines.size() > 0 && tracks.size() < kManyPoints;
}

}  // namespace

void PriorHypotheses::Clear() {
  hypotheses_.clear();
  sure_ = false;
}

void PriorHypotheses::Keep(const FeatureTracks& tracks,
                           std::span<const CandidateModel> models,
                           bool sure) {
  Clear();
  sure_ = sure;
  for (const CandidateModel& model : models) {
    Hypothesis kept{model.reconstruction.cam_from_reference.back(), {}};
    for (std::size_t k = 0; k < tracks.size(); ++k) {
      if (!model.reconstruction.is_known[k]) continue;
      kept.inverse_distances[tracks.features[k]] = 1 / model.reconstruction.points[k].norm();
    }
    hypotheses_.push_back(std::move(kept));
  }
}

std::vector<MotionHypothesis> PriorHypotheses::HypothesesFor(const FeatureTracks& tracks) const {
  std::vector<MotionHypothesis> hypotheses;
  for (const Hypothesis& kept : hypotheses_) {
    MotionHypothesis hypothesis{kept.newest_from_reference, {}};
    for (const int feature : tracks.features) {
      const auto found = kept.inverse_distances.find(feature);
      hypothesis.inverse_distances.push_back(found == kept.inverse_distances.end() ? 0
                                                                                   : found->second);
    }
    hypotheses.push_back(std::move(hypothesis));
  }
  return hypotheses;
}

bool PriorHypotheses::Confirm(const FeatureTracks& tracks,
                              const Reconstruction& reconstruction) const {
  if (!sure_) return false;
  const auto pose = ResectNewest(tracks, HypothesesFor(tracks).front());
  return pose && IsSameMotion(*pose, reconstruction.cam_from_reference.back());
}

double TurnChi2(const MeasuredTurns& turns, const Reconstruction& reconstruction) {
  const auto size = 3 * static_cast<Eigen::Index>(turns.of_views.size());
  Eigen::VectorXd residual(size);
  Eigen::MatrixXd by_errors(size, 7);
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(size, size);
  for (std::size_t i = 0; i < turns.of_views.size(); ++i) {
    const auto row = 3 * static_cast<Eigen::Index>(i);
    const CameraTurn& turn = turns.of_views[i];
    residual.segment<3>(row) =
        LogSo3(reconstruction.cam_from_reference[i].rotation * turn.b_from_a.conjugate());
    by_errors.middleRows<3>(row) = turn.by_errors;
    covariance.block<3, 3>(row, row) = turn.noise;
    covariance.block<3, 3>(row, row).diagonal().array() += kTurnSigma * kTurnSigma;
  }
  covariance += by_errors * turns.errors * by_errors.transpose();
  return residual.dot(covariance.ldlt().solve(residual));
}

ModelSelection SelectModel(const FeatureTracks& tracks,
                           const ModelSelectionOptions& options,
                           PriorHypotheses& prior,
                           Rng& rng,
                           const std::optional<MeasuredTurns>& turns) {
  using enum InitializationStatus;
  const std::vector<RayMatch> matches = MatchesBetween(tracks.reference, tracks.views.back());
  if (matches.size() < kMinPoints) return {.wait = kTooFewMatches};
  const auto motions = EstimateRelativePoses(matches, {.method = options.relative_pose}, rng);
  if (motions.empty()) return {.wait = kInaccurate};
  FeatureTracks scaled = tracks;
  ScaleSigmas(std::max(kMinNoise, NoiseOf(matches, motions.front().b_from_a)), scaled);
  std::vector<MotionHypothesis> hypotheses = prior.HypothesesFor(scaled);
  for (const RelativePoseHypothesis& motion : motions) hypotheses.push_back({motion.b_from_a, {}});

  std::vector<CandidateModel> models = FactorizeAll(scaled, hypotheses, options.factorization);
  if (models.empty()) return {.wait = kInaccurate};
  // Models that lines can tell apart may become one when they are adjusted to points alone, so that
  // the models from before adjustment are kept.
  std::vector<CandidateModel> before = models;
  AdjustAll(scaled, models);
  DropContradicted(turns, models);
  ModelSelection selection{.wait = Decide(scaled, models)};
  if (NeedsLines(scaled, selection.wait)) {
    models.insert(models.end(), before.begin(), before.end());
    models = AdjustWithLines(scaled, std::move(models), kMinNoise);
    DropContradicted(turns, models);
    selection.wait = Decide(scaled, models);
  }
  Reconstruction& best = models.front().reconstruction;
  selection.parallax_deg = ParallaxDeg(scaled, best);
  const bool sure = selection.wait == kNone;
  if (sure && !prior.Confirm(scaled, best)) selection.wait = kInaccurate;
  DropHopeless(models);
  prior.Keep(scaled, models, sure);
  if (selection.wait != kNone) return selection;
  ScaleToMedianDepth(best);
  selection.reconstruction = std::move(best);
  return selection;
}

}  // namespace plumbline

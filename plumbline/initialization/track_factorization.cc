// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/initialization/track_factorization.h"

#include "plumbline/base/statistics.h"
#include "plumbline/initialization/geometric_interpolation.h"
#include "plumbline/initialization/reconstruction_covariance.h"
#include "plumbline/optimization/pose_optimization.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace plumbline {
namespace {

// A point whose inverse distance is at most this part of the median counts as infinitely far. It
// gets this distance, at which it still constrains the rotations.
constexpr double kFarthest = 0.02;
// Largest chi2 of measurements that enter the covariance: 99.99 % of two degrees of freedom.
constexpr double kMaxChi2 = 18.4;
// Fewest points that must fit for the pose of a frame, absolutely and of those it shows.
constexpr int kMinResected = 10;
constexpr double kMinResectedShare = 0.5;

double MedianOfPositive(const std::vector<double>& inverse_distances) {
  std::vector<double> positive;
  for (const double d : inverse_distances) {
    if (d > 0) positive.push_back(d);
  }
  return UpperMedian(std::move(positive));
}

// Returns the points in space. Points near infinity are put at `kFarthest`.
Reconstruction ToReconstruction(const FeatureTracks& tracks,
                                const std::vector<double>& inverse_distances,
                                std::vector<Rigid3> poses) {
  Reconstruction reconstruction{std::move(poses), {}, {}};
  const double farthest = kFarthest * MedianOfPositive(inverse_distances);
  for (std::size_t k = 0; k < tracks.size(); ++k) {
    const double d = inverse_distances[k];
    const Eigen::Vector3d ray = tracks.reference.points[k].homogeneous().normalized();
    const bool known = d > -farthest && d != 0 && farthest > 0;
    reconstruction.points.push_back(known ? Eigen::Vector3d(ray / std::max(d, farthest)) : ray);
    reconstruction.is_known.push_back(known);
  }
  return reconstruction;
}

// Returns the structure from two frames alone: a factorization of one view.
std::optional<Reconstruction> StructureOfTwoFrames(const FeatureTracks& tracks,
                                                   const Rigid3& newest) {
  const Rank1View view = Rank1ViewOf(tracks.views.back(), newest);
  const auto factors =
      FactorizeRank1(tracks.reference.points, std::span(&view, 1), {.iterations = 0});
  if (!factors || 2 * factors->in_front <= factors->solved) return std::nullopt;
  const double sign = view.centre_direction.dot(factors->centres.front());
  // With the given sign of the translation most points must be in front.
  if (!(sign > 0)) return std::nullopt;
  std::vector<Rigid3> poses{newest};
  poses.front().translation.normalize();
  return ToReconstruction(tracks, factors->inverse_distances, std::move(poses));
}

// Returns the pose of a frame from its points; nullopt if the frame does not fit them.
std::optional<Rigid3> Resect(const FeatureTracks& tracks,
                             const ViewPoints& seen,
                             const Reconstruction& structure,
                             const Rigid3& guess) {
  PoseProblem problem;
  problem.camera.fx = problem.camera.fy = 1;
  problem.cam_from_world = guess;
  for (std::size_t k = 0; k < tracks.size(); ++k) {
    if (!structure.is_known[k] || !seen.Has(k)) continue;
    // The points are not known better than the measurements from which they come.
    const double sigma = std::sqrt(2.0) * seen.sigmas[k];
    problem.points.push_back({structure.points[k], {seen.points[k], sigma, std::nullopt}});
  }
  if (static_cast<int>(problem.points.size()) < kMinResected) return std::nullopt;
  const PoseOnlyResult result = SolvePose(problem);
  const auto matches = static_cast<double>(problem.points.size());
  if (result.inlier_points < kMinResected || result.inlier_points < kMinResectedShare * matches) {
    return std::nullopt;
  }
  return result.cam_from_world;
}

// Returns the poses of all views in the unit of the structure. With `newest_held` the newest pose
// stays as it is.
std::optional<std::vector<Rigid3>> ResectViews(const FeatureTracks& tracks,
                                               const Reconstruction& structure,
                                               bool newest_held) {
  const Rigid3& newest = structure.cam_from_reference.front();
  std::vector<Rigid3> poses;
  const auto m = static_cast<double>(tracks.views.size());
  const std::size_t solved = tracks.views.size() - (newest_held ? 1 : 0);
  for (std::size_t i = 0; i < solved; ++i) {
    const Rigid3 guess = Interpolate({}, newest, static_cast<double>(i + 1) / m);
    const auto pose = Resect(tracks, tracks.views[i], structure, guess);
    if (!pose) return std::nullopt;
    poses.push_back(*pose);
  }
  if (newest_held) poses.push_back(newest);
  return poses;
}

// Returns the inverse distances of all points from known poses. A point lies along the unit ray p
// of the reference, at the inverse distance d that makes R p + d t parallel to the measured rays,
// by linear least squares over all views.
std::vector<double> InverseDistances(const FeatureTracks& tracks,
                                     const std::vector<Rigid3>& poses) {
  std::vector<double> inverse_distances;
  for (std::size_t k = 0; k < tracks.size(); ++k) {
    const Eigen::Vector3d p = tracks.reference.points[k].homogeneous().normalized();
    double along = 0;
    double squared = 0;
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const ViewPoints& seen = tracks.views[i];
      if (!seen.Has(k)) continue;
      const Eigen::Vector3d ray = seen.points[k].homogeneous().normalized() / seen.sigmas[k];
      const Eigen::Vector3d across = ray.cross(poses[i].translation);
      along -= across.dot(ray.cross(poses[i].rotation * p));
      squared += across.squaredNorm();
    }
    inverse_distances.push_back(squared > 0 ? along / squared : 0);
  }
  return inverse_distances;
}

// Factorizes the views and puts the resulting centres into the poses.
std::optional<Reconstruction> Factorize(const FeatureTracks& tracks,
                                        const std::vector<ViewPoints>& seen,
                                        const std::vector<Rigid3>& poses,
                                        const FactorizationOptions& options) {
  std::vector<Rank1View> views;
  for (std::size_t i = 0; i < seen.size(); ++i) views.push_back(Rank1ViewOf(seen[i], poses[i]));
  Rank1Options rank1;
  if (options.reweighting > 0) {
    rank1.iterations = options.reweighting;
  } else {
    rank1.loss_width = std::numeric_limits<double>::infinity();  // every known entry counts in full
  }
  const auto factors = FactorizeRank1(tracks.reference.points, views, rank1);
  if (!factors || 2 * factors->in_front <= factors->solved) return std::nullopt;
  std::vector<Rigid3> solved = poses;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    solved[i].translation = -(poses[i].rotation * factors->centres[i]);
  }
  return ToReconstruction(tracks, factors->inverse_distances, std::move(solved));
}

// Returns the views with only the points that all of them show.
std::vector<ViewPoints> CompleteTracks(const FeatureTracks& tracks) {
  std::vector<ViewPoints> complete = tracks.views;
  for (std::size_t k = 0; k < tracks.size(); ++k) {
    const bool all = std::all_of(tracks.views.begin(),
                                 tracks.views.end(),
                                 [k](const ViewPoints& view) { return view.Has(k); });
    if (all) continue;
    for (ViewPoints& view : complete) view.sigmas[k] = 0;
  }
  return complete;
}

// Returns the views, with missing points interpolated between the reference and the newest frame.
std::vector<ViewPoints> InterpolateMissing(const FeatureTracks& tracks,
                                           const Reconstruction& solution,
                                           const FactorizationOptions& options) {
  std::vector<ViewPoints> completed = tracks.views;
  const auto covariance = ComputeCovariance(tracks, solution, 1, kMaxChi2);
  if (!covariance) return completed;
  const ViewPoints& newest = tracks.views.back();
  const auto last = static_cast<Eigen::Index>(6 * (tracks.views.size() - 1));
  for (std::size_t i = 0; i + 1 < completed.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(6 * i);
    InterpolationPoses poses{solution.cam_from_reference[i], solution.cam_from_reference.back()};
    poses.covariance << covariance->poses.block<6, 6>(row, row),
        covariance->poses.block<6, 6>(row, last), covariance->poses.block<6, 6>(last, row),
        covariance->poses.block<6, 6>(last, last);
    const GeometricInterpolation interpolation(poses);
    for (std::size_t k = 0; k < tracks.size(); ++k) {
      if (completed[i].Has(k) || !newest.Has(k)) continue;
      const auto place = interpolation.Interpolate(tracks.reference.points[k],
                                                   tracks.reference.sigmas[k],
                                                   newest.points[k],
                                                   newest.sigmas[k]);
      if (!place || place->line_angle < options.min_line_angle) continue;
      const double sigma = std::sqrt(place->covariance.trace() / 2);
      if (!(sigma <= options.max_interpolation_sigma)) continue;
      completed[i].points[k] = place->point;
      completed[i].sigmas[k] = sigma;
    }
  }
  return completed;
}

int CountPlaces(const std::vector<ViewPoints>& views) {
  std::size_t places = 0;
  for (const ViewPoints& view : views) places += view.CountSeen();
  return static_cast<int>(places);
}

// Returns the inverse distances of all points from the reference and one view with a translation of
// length one.
std::vector<double> InverseDistancesOfPair(const FeatureTracks& tracks,
                                           const ViewPoints& view,
                                           const Rigid3& pose) {
  FeatureTracks pair;
  pair.reference = tracks.reference;
  pair.views = {view};
  return InverseDistances(pair, {pose});
}

// Scales each translation, the first to length one: common points of a frame and the previous one
// have one distance, known from the pairs of both frames with the reference in units of their
// translations. Returns nullopt if two successive frames have no common point.
std::optional<std::vector<Rigid3>> ChainLengths(const FeatureTracks& tracks,
                                                std::vector<Rigid3> poses) {
  std::vector<double> before = InverseDistancesOfPair(tracks, tracks.views[0], poses[0]);
  double length = 1;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const std::vector<double> now = InverseDistancesOfPair(tracks, tracks.views[i], poses[i]);
    std::vector<double> ratios;
    for (std::size_t k = 0; k < now.size(); ++k) {
      if (before[k] > 0 && now[k] > 0) ratios.push_back(now[k] / before[k]);
    }
    if (ratios.empty()) return std::nullopt;
    length *= UpperMedian(std::move(ratios));
    poses[i].translation *= length;
    before = now;
  }
  return poses;
}

}  // namespace

std::optional<PairwiseReconstruction> FactorizePairwise(const FeatureTracks& tracks,
                                                        const std::vector<Rigid3>& poses,
                                                        MissingPlaces missing,
                                                        const FactorizationOptions& options) {
  const auto triangulated = [&](const std::vector<Rigid3>& scaled) {
    return PairwiseReconstruction{
        ToReconstruction(tracks, InverseDistances(tracks, scaled), scaled)};
  };
  if (!options.factorize) {
    const auto scaled = ChainLengths(tracks, poses);
    return scaled ? std::optional(triangulated(*scaled)) : std::nullopt;
  }
  std::vector<ViewPoints> completed = CompleteTracks(tracks);
  auto first = Factorize(tracks, completed, poses, options);
  if (!first) {
    completed = tracks.views;
    first = Factorize(tracks, completed, poses, options);
  }
  if (!first) return std::nullopt;
  int interpolated = 0;
  if (missing == MissingPlaces::kLeaveOut) completed = tracks.views;
  if (missing == MissingPlaces::kInterpolate) {
    completed = InterpolateMissing(tracks, *first, options);
    interpolated = CountPlaces(completed) - CountPlaces(tracks.views);
  }
  auto all = Factorize(tracks, completed, first->cam_from_reference, options);
  if (!all) return std::nullopt;
  if (missing == MissingPlaces::kTriangulate) return triangulated(all->cam_from_reference);
  return PairwiseReconstruction{*std::move(all), interpolated};
}

std::optional<Rigid3> ResectNewest(const FeatureTracks& tracks,
                                   const MotionHypothesis& hypothesis) {
  const Rigid3& guess = hypothesis.newest_from_reference;
  const Reconstruction structure = ToReconstruction(tracks, hypothesis.inverse_distances, {guess});
  return Resect(tracks, tracks.views.back(), structure, guess);
}

Rank1View Rank1ViewOf(const ViewPoints& seen, const Rigid3& pose) {
  const Rigid3 reference_from_cam = Inverse(pose);
  const double length = reference_from_cam.translation.norm();
  return {reference_from_cam.rotation,
          length > 0 ? Eigen::Vector3d(reference_from_cam.translation / length)
                     : Eigen::Vector3d::UnitX(),
          seen.points,
          seen.sigmas};
}

std::optional<Reconstruction> FactorizeTracks(const FeatureTracks& tracks,
                                              const MotionHypothesis& hypothesis,
                                              const FactorizationOptions& options) {
  const bool two_frames = hypothesis.inverse_distances.empty();
  const Rigid3& newest = hypothesis.newest_from_reference;
  const auto structure = two_frames
                             ? StructureOfTwoFrames(tracks, newest)
                             : ToReconstruction(tracks, hypothesis.inverse_distances, {newest});
  if (!structure) return std::nullopt;
  const auto poses = ResectViews(tracks, *structure, two_frames);
  if (!poses) return std::nullopt;
  if (!options.factorize) return ToReconstruction(tracks, InverseDistances(tracks, *poses), *poses);
  auto first = Factorize(tracks, CompleteTracks(tracks), *poses, options);
  if (!options.interpolate) return first;
  // Few tracks are complete: the first factorization then uses incomplete ones, too.
  if (!first) first = Factorize(tracks, tracks.views, *poses, options);
  if (!first) return std::nullopt;
  const auto completed = InterpolateMissing(tracks, *first, options);
  return Factorize(tracks, completed, first->cam_from_reference, options);
}

}  // namespace plumbline

// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/initialization_timing.h"

#include "plumbline/base/elementary.h"
#include "plumbline/base/random.h"
#include "plumbline/initialization/geometric_interpolation.h"
#include "plumbline/initialization/rank1_factorization.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace plumbline {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kFrames = 3;
constexpr double kSigma = 1e-3;  // of a measured ideal coordinate: half a pixel at f = 500

constexpr std::array kMetrics = {
    FigureMetric{"centre_error", "deg", "direction of the last camera's centre, median", 4},
    FigureMetric{"interpolation_time",
                 "ms",
                 "all points into one of the frames between, by the clock, median",
                 4},
    FigureMetric{"factorization_time", "ms", "matrix and plain factorization, median", 4},
    FigureMetric{"reweighted_time", "ms", "the same with five steps of reweighting, median", 4},
};

// A camera that goes sideways past points 2 to 8 m ahead.
struct Window {
  std::vector<Rigid3> cam_from_reference;   // of the frames after the reference
  std::vector<Vector2d> reference;          // measured points
  std::vector<std::vector<Vector2d>> seen;  // by frame
};

Window MakeWindow(int points, Rng& rng) {
  Window window;
  for (int i = 1; i <= kFrames; ++i) {
    Rigid3 pose;
    pose.rotation = Eigen::Quaterniond(1, 0.002 * i, 0.006 * i, 0).normalized();
    pose.translation = Vector3d(-0.08 * i, 0.01 * i * i, 0.02 * i);
    window.cam_from_reference.push_back(pose);
  }
  window.seen.resize(kFrames);
  const auto measured = [&](const Vector3d& point) {
    return Vector2d(point.hnormalized() + kSigma * Vector2d(rng.Normal(), rng.Normal()));
  };
  for (int k = 0; k < points; ++k) {
    const double depth = rng.Uniform(2, 8);
    const Vector3d point(depth * rng.Uniform(-0.6, 0.6), depth * rng.Uniform(-0.4, 0.4), depth);
    window.reference.push_back(measured(point));
    for (int i = 0; i < kFrames; ++i) {
      window.seen[static_cast<std::size_t>(i)].push_back(
          measured(window.cam_from_reference[static_cast<std::size_t>(i)] * point));
    }
  }
  return window;
}

// The views of a window in which a fifth of the points of the frames between the reference and the
// last are not observed but interpolated.
std::vector<Rank1View> InterpolatedViews(const Window& window, double& milliseconds) {
  std::vector<Rank1View> views;
  for (std::size_t i = 0; i < kFrames; ++i) {
    const Rigid3 reference_from_cam = Inverse(window.cam_from_reference[i]);
    views.push_back({reference_from_cam.rotation,
                     reference_from_cam.translation.normalized(),
                     window.seen[i],
                     std::vector<double>(window.seen[i].size(), kSigma)});
  }
  InterpolationPoses poses{window.cam_from_reference.front(), window.cam_from_reference.back()};
  poses.covariance.setIdentity();
  poses.covariance *= 1e-8;
  std::vector<std::optional<InterpolatedPoint>> all(window.reference.size());
  const auto start = std::chrono::steady_clock::now();
  const GeometricInterpolation interpolation(poses);
  for (std::size_t k = 0; k < all.size(); ++k) {
    all[k] = interpolation.Interpolate(window.reference[k], kSigma, window.seen.back()[k], kSigma);
  }
  const auto end = std::chrono::steady_clock::now();
  milliseconds = std::chrono::duration<double, std::milli>(end - start).count();
  constexpr std::size_t kEvery = 5;
  for (std::size_t k = 0; k < all.size(); k += kEvery) {
    if (!all[k]) continue;
    views.front().points[k] = all[k]->point;
    views.front().sigmas[k] = std::sqrt(0.5 * all[k]->covariance.trace());
  }
  return views;
}

struct Times {
  std::vector<double> interpolation, plain, reweighted, error_deg;
};

double TimeFactorization(const Window& window,
                         const std::vector<Rank1View>& views,
                         int iterations,
                         std::optional<Rank1Solution>& solution) {
  const auto start = std::chrono::steady_clock::now();
  solution = FactorizeRank1(window.reference, views, {.iterations = iterations});
  const auto end = std::chrono::steady_clock::now();
  return std::chrono::duration<double, std::milli>(end - start).count();
}

void TryWindow(int points, Rng& rng, Times& times) {
  const Window window = MakeWindow(points, rng);
  double interpolation = 0;
  const auto views = InterpolatedViews(window, interpolation);
  times.interpolation.push_back(interpolation);
  std::optional<Rank1Solution> solution;
  times.plain.push_back(TimeFactorization(window, views, 0, solution));
  times.reweighted.push_back(TimeFactorization(window, views, Rank1Options{}.iterations, solution));
  if (!solution) return;
  const Vector3d truth = Inverse(window.cam_from_reference.back()).translation.normalized();
  const double sine = solution->centres.back().normalized().cross(truth).norm();
  times.error_deg.push_back(180 / std::numbers::pi * math::Asin(std::min(1.0, sine)));
}

double Median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

}  // namespace

std::span<const FigureMetric> InitializationTimingMetrics() { return kMetrics; }

std::optional<TimedFigures> TimeInitialization(
    int repeats, const std::function<bool(std::size_t, std::size_t)>& progress) {
  constexpr std::array kPoints = {200, 300, 500};
  TimedFigures out;
  std::size_t done = 0;
  for (const int points : kPoints) {
    Times times;
    for (int i = 0; i < repeats; ++i) {
      Rng rng(1, "initialization_timing", static_cast<std::uint64_t>(1000 * points + i));
      TryWindow(points, rng, times);
    }
    const std::string sequence = fmt::format("points/{}", points), variant = "m3";
    FigureRow error{sequence, variant, {}, "centre_error", {}, "deg"};
    if (times.error_deg.empty()) {
      error.reason = "no window could be factorized";
    } else {
      error.value = Median(times.error_deg);
    }
    out.figures.push_back(error);
    out.times.push_back(
        {sequence, variant, {}, "interpolation_time", Median(times.interpolation), "ms"});
    out.times.push_back({sequence, variant, {}, "factorization_time", Median(times.plain), "ms"});
    out.times.push_back({sequence, variant, {}, "reweighted_time", Median(times.reweighted), "ms"});
    if (!progress(++done, kPoints.size())) return std::nullopt;
  }
  return out;
}

}  // namespace plumbline

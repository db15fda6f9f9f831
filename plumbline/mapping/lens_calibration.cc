// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/mapping/lens_calibration.h"

#include "plumbline/geometry/measured_depth.h"
#include "plumbline/optimization/bundle_adjustment.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <map>
#include <optional>
#include <utility>

namespace plumbline {
namespace {

// Prior deviation of the correction, relative to the width of the image.
constexpr double kPriorSigma = 0.01;
// Mean shift, relative to the width of the image, that the deviations of corners allow for already.
constexpr double kAllowed = 5e-4;

// The cost of a map's points as a function of the correction, in pixels at the border.
class Profile {
 public:
  Profile(const BaProblem& problem, const StopCheck& stop) : problem_(problem), stop_(stop) {}

  // Returns nullopt if the numbers are not finite, and when stopped.
  std::optional<double> At(double border_px) {
    const auto known = solved_.find(border_px);
    if (known != solved_.end()) return known->second.final_cost;
    BaProblem corrected;
    corrected.camera = problem_.camera;
    corrected.poses = problem_.poses;
    corrected.points = problem_.points;
    corrected.point_observations = problem_.point_observations;
    if (!solved_.empty()) TakePosesAndPoints(Nearest(border_px), corrected);
    Correct({corrected.camera, border_px}, corrected);
    LocalBaOptions options;
    // No observation is taken out, so that all costs count the same observations.
    options.rounds = 1;
    options.max_iterations = 40;
    options.function_tolerance = 1e-6;
    BaResult result = SolveLocalBa(corrected, options, stop_);
    if (result.termination == BaTermination::kStopped ||
        result.termination == BaTermination::kNotFinite ||
        result.termination == BaTermination::kNothingToDo) {
      return std::nullopt;
    }
    const double cost = result.final_cost;
    solved_[border_px] = std::move(result);
    return cost;
  }

  // Returns the solution for the nearest correction that has been solved; at least one must have
  // been.
  const BaResult& Nearest(double border_px) const {
    const auto after = solved_.lower_bound(border_px);
    if (after == solved_.begin()) return after->second;
    const auto before = std::prev(after);
    const bool first =
        after == solved_.end() || border_px - before->first < after->first - border_px;
    return (first ? before : after)->second;
  }

 private:
  const BaProblem& problem_;
  const StopCheck& stop_;
  std::map<double, BaResult> solved_;  // the solution for each correction
};

struct Parabola {
  double minimum = 0;    // correction at which the cost is least
  double curvature = 0;  // second derivative of the cost

  // Returns the decrease of the cost by the correction at the minimum, compared with no correction.
  // Valid for a parabola fitted around zero.
  double Gain() const { return 0.5 * curvature * minimum * minimum; }
  // Returns the largest correction that is within so many deviations of the minimum.
  double Most(double sigmas) const { return std::abs(minimum) + sigmas / std::sqrt(curvature); }
};

// Returns the parabola through the costs at `middle` and at `step` before and after it.
Parabola Through(double middle, double step, const std::array<double, 3>& costs) {
  const double slope = (costs[2] - costs[0]) / (2 * step);
  const double curvature = (costs[0] - 2 * costs[1] + costs[2]) / (step * step);
  return {middle - slope / curvature, curvature};
}

// Returns the displacement of the points of a problem by a correction of one pixel at the border,
// as the root mean square [px].
double MeanSize(const BaProblem& problem) {
  const LensCorrection one(problem.camera, 1);
  double sum = 0;
  for (const auto& o : problem.point_observations) {
    sum += one.ShiftAt(o.measurement.px).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(problem.point_observations.size()));
}

// Returns true if a correction moves the points by more than their deviations allow for already.
bool Matters(double border_px, const BaProblem& problem) {
  return std::abs(border_px) * MeanSize(problem) > kAllowed * problem.camera.width;
}

// Fits a parabola to the profile around `middle`; nullopt if it has no minimum nearby.
std::optional<Parabola> FitAround(Profile& profile, double middle, double step, double most) {
  std::array<double, 3> costs{};
  for (const std::size_t i : {1, 0, 2}) {
    const auto cost = profile.At(middle + (static_cast<double>(i) - 1) * step);
    if (!cost) return std::nullopt;
    costs[i] = *cost;
  }
  const Parabola fit = Through(middle, step, costs);
  if (!(fit.curvature > 0) || !(std::abs(fit.minimum) < most)) return std::nullopt;
  return fit;
}

}  // namespace

void Correct(const LensCorrection& correction, BaProblem& problem) {
  for (auto& o : problem.point_observations) {
    o.measurement.sigma_px *= correction.ScaleAt(o.measurement.px);
    o.measurement.px = correction.At(o.measurement.px);
  }
  for (auto& o : problem.line_observations) {
    if (o.measurement.camera != 0) continue;
    Segment2& segment = o.measurement.segment;
    const double scale = correction.ScaleAt(segment.Midpoint());
    o.measurement.covariance *= scale * scale;
    segment = correction.At(segment);
  }
}

RadialCalibration CalibrateRadialDistortion(const BaProblem& problem,
                                            double known_px,
                                            const StopCheck& stop) {
  // Steps between corrections, relative to the width of the image. With the first step all points
  // stay close to their positions, which takes few iterations; the second leads to the positions of
  // a large correction.
  constexpr double kFirstStep = 0.0005;
  constexpr double kStep = 0.002;
  constexpr double kMost = 3;  // largest correction and change, in deviations of the prior
  // In a map of a camera in straight motion, 4.6 deviations spoke for a correction without any
  // distortion: an error of a corner is the same in all its views, but the cost assumes independent
  // views.
  constexpr double kSigmas = 6;
  constexpr double kEnough = 0.5 * kSigmas * kSigmas;  // least decrease of the cost
  constexpr double kSurely = 4;                        // deviations that exclude a correction
  // A smaller change of the known correction, relative to the width, is not worth an adjustment.
  constexpr double kLeastChange = 2e-4;
  if (MeasuresDepth(problem.camera) || problem.point_observations.empty()) return {};
  const double width = problem.camera.width;
  const double sigma = kPriorSigma * width;
  const double step = kStep * width;
  Profile profile(problem, stop);
  std::optional<Parabola> fit;
  if (known_px == 0) {
    fit = FitAround(profile, 0, kFirstStep * width, kMost * sigma);
    // Longer steps change the gain that short ones find by far less than a factor of two, so that
    // half of kEnough is a safe limit.
    if (!fit) return {};
    if (fit->Gain() < 0.5 * kEnough) {
      return {{}, {}, {}, !Matters(fit->Most(kSurely), problem)};
    }
  }
  fit = FitAround(profile, 0, step, kMost * sigma);
  if (!fit) return {};
  // The profile is a parabola only near its minimum, so that a distant minimum is fitted again. If
  // that leads elsewhere, points have got stuck on the way.
  if (std::abs(fit->minimum) > step) {
    const double middle = fit->minimum;
    fit = FitAround(profile, middle, step, kMost * sigma);
    if (!fit || std::abs(fit->minimum - middle) > step) return {};
  }
  const double whole =
      (known_px + fit->minimum) * fit->curvature / (fit->curvature + 1 / (sigma * sigma));
  if (!(std::abs(whole) < kMost * sigma)) return {};
  const std::optional<double> as_it_is = profile.At(0);
  const std::optional<double> without = profile.At(-known_px);
  const std::optional<double> with = profile.At(whole - known_px);
  if (!as_it_is || !without || !with) return {};
  const bool counts = *without - *with > kEnough && Matters(whole, problem);
  const bool contradicted = *as_it_is - *without > kEnough;
  if (!counts && !contradicted) return {};
  const double change = (counts ? whole : 0) - known_px;
  if (std::abs(change) < kLeastChange * width) return {};
  const BaResult& solution = profile.Nearest(change);
  return {{problem.camera, change}, solution.poses, solution.points};
}

}  // namespace plumbline

// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/mapping/lens_calibration.h"

#include "plumbline/geometry/measured_depth.h"
#include "plumbline/optimization/ba_terms.h"
#include "plumbline/optimization/bundle_adjustment.h"
#include "plumbline/optimization/schur_solver.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <map>
#include <numeric>
#include <optional>
#include <span>
#include <utility>

namespace plumbline {
namespace {

// Prior deviation of the correction, relative to the width of the image.
constexpr double kPriorSigma = 0.01;
// Mean shift, relative to the width of the image, that the deviations of corners allow for already.
constexpr double kAllowed = 5e-4;

struct Parabola {
  double minimum = 0;    // correction at which the cost is least
  double curvature = 0;  // second derivative of the cost

  // Returns the decrease of the cost by the correction at the minimum, compared with no correction.
  // Valid for a parabola fitted around zero.
  double Gain() const { return 0.5 * curvature * minimum * minimum; }
  // Returns the largest correction that is within so many deviations of the minimum.
  double Most(double sigmas) const { return std::abs(minimum) + sigmas / std::sqrt(curvature); }
};

// Returns a measurement of the left image as a correction leaves it.
PointMeasurement Corrected(const LensCorrection& correction, PointMeasurement measurement) {
  measurement.sigma_px *= correction.ScaleAt(measurement.px);
  measurement.px = correction.At(measurement.px);
  return measurement;
}

// The normal equations of poses, points and the correction at a solution, to second order of the
// cost as in bundle adjustment. The correction is one more pose, of which the first parameter alone
// counts. Eliminating everything else tells how the cost depends on it.
class LensEquations {
 public:
  LensEquations(const BaProblem& problem, double border_px, const BaResult& solution)
      : problem_(problem),
        solution_(solution),
        border_px_(border_px),
        poses_(problem.poses.size()),
        free_poses_(0) {
    for (std::size_t i = 0; i < poses_.size(); ++i) {
      poses_[i].Set(solution.poses[i]);
      if (!problem.poses[i].fixed) poses_[i].free_index = free_poses_++;
    }
  }

  // Returns the parabola of the cost; nullopt if the equations are not positive definite, and when
  // stopped.
  std::optional<Parabola> Solve(const StopCheck& stop) {
    SchurSolver solver(free_poses_ + 1);
    EliminatePoints(solver);
    PoseEquations& lens = solver.pose(free_poses_);
    lens.H = lens_curvature_ * Matrix6d::Identity();
    std::vector<Vector6d> gradients;
    for (int i = 0; i < free_poses_; ++i) {
      gradients.push_back(std::exchange(solver.pose(i).g, Vector6d::Zero()));
      Matrix6d block = Matrix6d::Zero();
      block.row(0) = of_pose_[static_cast<std::size_t>(i)];
      solver.AddCoupling(free_poses_, i, block);
    }
    // The step against a gradient of one of the lens alone.
    lens.g(0) = -1;
    if (IsToStop(stop) || !solver.Solve(kLambda, stop)) return std::nullopt;
    const double of_lens = solver.step(free_poses_)(0);
    double change = lens_gradient_ * of_lens;
    for (int i = 0; i < free_poses_; ++i) {
      change += gradients[static_cast<std::size_t>(i)].dot(solver.step(i));
    }
    for (const Point& point : points_) {
      const auto step = solver.LandmarkStep<3, float>(point.eliminated, std::span(point.couplings));
      change += point.gradient.dot(step);
    }
    return Parabola{border_px_ - change, 1 / of_lens};
  }

 private:
  // Damping of the end of an adjustment.
  static constexpr double kLambda = 1e-6;
  static constexpr double kStepPx = 1e-3;  // of differences with respect to the correction
  struct Point {
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
    EliminatedLandmark<3> eliminated;
    std::vector<Coupling<3, float>> couplings;
  };

  void EliminatePoints(SchurSolver& solver) {
    of_pose_.assign(static_cast<std::size_t>(free_poses_), Vector6d::Zero());
    const auto& all = problem_.point_observations;
    std::vector<std::size_t> order(all.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return std::pair(all[a].point, all[a].pose) < std::pair(all[b].point, all[b].pose);
    });
    for (std::size_t first = 0, end = 0; first < order.size(); first = end) {
      while (end < order.size() && all[order[end]].point == all[order[first]].point) ++end;
      EliminatePoint(std::span(order).subspan(first, end - first), solver);
    }
  }

  void EliminatePoint(std::span<const std::size_t> observations, SchurSolver& solver) {
    LandmarkEquations<3> equations;
    std::vector<Coupling<3>> couplings;
    Eigen::Vector3d of_point = Eigen::Vector3d::Zero();  // its coupling with the lens
    for (const std::size_t k : observations) {
      const auto& o = problem_.point_observations[k];
      const BaPose& pose = poses_[static_cast<std::size_t>(o.pose)];
      const Eigen::Vector3d& place = solution_.points[static_cast<std::size_t>(o.point)];
      if (pose.free_index >= 0 && (couplings.empty() || couplings.back().pose != pose.free_index)) {
        couplings.push_back({pose.free_index});
      }
      const PointTerm term = TermAt(o.measurement, 0);
      BaTarget<3> target{equations, nullptr, nullptr};
      if (pose.free_index >= 0) {
        target.pose = &solver.pose(pose.free_index);
        target.W = &couplings.back().W;
      }
      const double huber = BaPoint::Huber(term, kHuberThresholds);
      if (!BaPoint::Add(problem_.camera, pose, place, term, huber, target)) continue;
      const Eigen::Vector3d p = pose.ToCamera(place);
      PointLinearization at, more, less;
      LinearizePoint(problem_.camera, term, p, at);
      LinearizePoint(problem_.camera, TermAt(o.measurement, kStepPx), p, more);
      LinearizePoint(problem_.camera, TermAt(o.measurement, -kStepPx), p, less);
      const Eigen::Vector3d d = (more.r - less.r) / (2 * kStepPx);
      const double w = HuberWeight(at.r.squaredNorm(), huber);
      const Eigen::Vector3d q = w * (PointJacobian(at).transpose() * d);
      lens_curvature_ += w * d.squaredNorm();
      lens_gradient_ += w * d.dot(at.r);
      of_point += pose.R.transpose() * q;
      if (pose.free_index < 0) continue;
      Vector6d& of_pose = of_pose_[static_cast<std::size_t>(pose.free_index)];
      of_pose.head<3>() += p.cross(q);
      of_pose.tail<3>() += q;
    }
    couplings.push_back({free_poses_});
    couplings.back().W.row(0) = of_point;
    Point point;
    point.gradient = std::exchange(equations.g, Eigen::Vector3d::Zero());
    point.eliminated = solver.Eliminate<3>(equations, kLambda, std::span(couplings));
    for (const Coupling<3>& c : couplings) point.couplings.push_back({c.pose, c.W.cast<float>()});
    points_.push_back(std::move(point));
  }

  PointTerm TermAt(const PointMeasurement& measurement, double change_px) const {
    return MakePointTerm(
        Corrected(LensCorrection(problem_.camera, border_px_ + change_px), measurement));
  }

  const BaProblem& problem_;
  const BaResult& solution_;
  double border_px_;
  std::vector<BaPose> poses_;
  int free_poses_;
  std::vector<Point> points_;
  std::vector<Vector6d> of_pose_;  // coupling of each free pose with the lens
  double lens_curvature_ = 0, lens_gradient_ = 0;
};

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
    BaResult result = SolveLocalBa(corrected, LensAdjustmentOptions({}), stop_);
    if (result.termination == BaTermination::kStopped ||
        result.termination == BaTermination::kNotFinite ||
        result.termination == BaTermination::kNothingToDo) {
      return std::nullopt;
    }
    const double cost = result.final_cost;
    solved_[border_px] = std::move(result);
    return cost;
  }

  // Returns the parabola of the cost at a correction that has been solved; nullopt if it has no
  // minimum nearby, and when stopped.
  std::optional<Parabola> FitAt(double border_px, double most) {
    if (!At(border_px)) return std::nullopt;
    const std::optional<Parabola> fit =
        LensEquations(problem_, border_px, solved_.at(border_px)).Solve(stop_);
    if (!fit || !(fit->curvature > 0) || !(std::abs(fit->minimum) < most)) return std::nullopt;
    return fit;
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

}  // namespace

LocalBaOptions LensAdjustmentOptions(LocalBaOptions options) {
  options.rounds = 1;
  options.max_iterations = 40;
  options.function_tolerance = 1e-6;
  options.carry_points = true;
  return options;
}

void Correct(const LensCorrection& correction, BaProblem& problem) {
  for (auto& o : problem.point_observations) o.measurement = Corrected(correction, o.measurement);
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
  // The profile is a parabola only near its minimum, so that a distant minimum is fitted again.
  constexpr int kFits = 4;
  constexpr double kStep = 0.002;  // largest last change, relative to the width of the image
  constexpr double kMost = 3;      // largest correction and change, in deviations of the prior
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
  Profile profile(problem, stop);
  std::optional<Parabola> fit = profile.FitAt(0, kMost * sigma);
  if (!fit) return {};
  // Further away the gain is not more than a factor of two from what it is here, so that half of
  // kEnough is a safe limit.
  if (known_px == 0 && fit->Gain() < 0.5 * kEnough) {
    return {{}, {}, {}, !Matters(fit->Most(kSurely), problem)};
  }
  double last = 0;
  for (int i = 0; i < kFits && std::abs(fit->minimum - last) > kLeastChange * width; ++i) {
    last = fit->minimum;
    fit = profile.FitAt(last, kMost * sigma);
    if (!fit) return {};
  }
  // Points have got stuck on the way.
  if (std::abs(fit->minimum - last) > kStep * width) return {};
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

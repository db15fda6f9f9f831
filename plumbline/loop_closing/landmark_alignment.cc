// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/loop_closing/landmark_alignment.h"

#include "plumbline/base/statistics.h"
#include "plumbline/geometry/alignment.h"
#include "plumbline/geometry/se3.h"
#include "plumbline/matching/measurements.h"
#include "plumbline/optimization/residuals.h"
#include "plumbline/solvers/ransac.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include <Eigen/Cholesky>

namespace plumbline {
namespace {

constexpr double kNearest = 1e-6;  // depth below which a point has no residual
constexpr double kHuber = 2.5;     // threshold on the norm of a whitened residual

using Jacobian = Eigen::Matrix<double, 4, 7>;

// A whitened residual. Landmarks behind a camera have none.
struct Residual {
  int rows = 0;
  Eigen::Vector4d r = Eigen::Vector4d::Zero();
  Jacobian J = Jacobian::Zero();
};

// Returns the derivative of candidate_from_query * X at p = candidate_from_query * X.
Eigen::Matrix<double, 3, 7> PointByPose(const Eigen::Vector3d& p) {
  Eigen::Matrix<double, 3, 7> J;
  J << -Skew(p), Eigen::Matrix3d::Identity(), p;
  return J;
}

// Returns column, row, and inverse depth in pixels of a camera with a baseline of one.
Eigen::Vector3d View(const RectifiedCamera& camera, const Eigen::Vector3d& p) {
  return {camera.fx * p.x() / p.z(), camera.fy * p.y() / p.z(), camera.fx / p.z()};
}

Eigen::Matrix3d ViewJacobian(const RectifiedCamera& camera, const Eigen::Vector3d& p) {
  const double iz = 1 / p.z();
  Eigen::Matrix3d J;
  J << camera.fx * iz, 0, -camera.fx * p.x() * iz * iz,  //
      0, camera.fy * iz, -camera.fy * p.y() * iz * iz,   //
      0, 0, -camera.fx * iz * iz;
  return J;
}

// Whitens by the Cholesky factor; returns false if the covariance is not positive definite.
template <int kRows>
bool Whiten(const Eigen::Matrix<double, kRows, kRows>& covariance,
            const Eigen::Matrix<double, kRows, 1>& r,
            const Eigen::Matrix<double, kRows, 7>* J,
            Residual& out) {
  const Eigen::LLT<Eigen::Matrix<double, kRows, kRows>> factor(covariance);
  if (factor.info() != Eigen::Success) return false;
  out.rows = kRows;
  out.r.template head<kRows>() = factor.matrixL().solve(r);
  if (J != nullptr) out.J.template topRows<kRows>() = factor.matrixL().solve(*J);
  return out.r.allFinite();
}

class Evaluator {
 public:
  Evaluator(const RectifiedCamera& camera, const Similarity3& candidate_from_query)
      : camera_(camera),
        s_(candidate_from_query),
        inverse_(Inverse(candidate_from_query)),
        turn_(candidate_from_query.scale * candidate_from_query.rotation.toRotationMatrix()) {}

  bool operator()(const LandmarkPair<CameraPoint>& pair, bool derivative, Residual& out) const {
    const Eigen::Vector3d p = s_ * pair.in_query.place;
    const Eigen::Vector3d& q = pair.in_candidate.place;
    if (!(p.z() > kNearest && q.z() > kNearest)) return false;
    const Eigen::Matrix3d J_p = ViewJacobian(camera_, p);
    const Eigen::Matrix3d J_q = ViewJacobian(camera_, q);
    const Eigen::Matrix3d J_turned = J_p * turn_;
    const Eigen::Matrix3d covariance = J_q * pair.in_candidate.covariance * J_q.transpose() +
                                       J_turned * pair.in_query.covariance * J_turned.transpose();
    const Eigen::Vector3d r = View(camera_, p) - View(camera_, q);
    if (!derivative) return Whiten<3>(covariance, r, nullptr, out);
    const Eigen::Matrix<double, 3, 7> J = J_p * PointByPose(p);
    return Whiten<3>(covariance, r, &J, out);
  }

  bool operator()(const LandmarkPair<LineModel>& pair, bool derivative, Residual& out) const {
    const PluckerLine& from = pair.in_query.line;
    const PluckerLine& to = pair.in_candidate.line;
    if (!((s_.rotation * from.direction).dot(to.direction) > 0)) return false;
    const auto places = PlacesOnBoth(pair);
    const Eigen::Matrix<double, 2, 3> across = BasisAcross(to.direction).transpose();
    const OrthonormalLine from_form = ToOrthonormal(from);
    const OrthonormalLine to_form = ToOrthonormal(to);
    Eigen::Vector4d r;
    Eigen::Matrix4d by_from;
    Eigen::Matrix4d by_to;
    Eigen::Matrix<double, 4, 7> J;
    for (int k = 0; k < 2; ++k) {
      const Eigen::Vector3d p = s_ * from.PointAt(places[static_cast<std::size_t>(k)]);
      const double t = to.ParameterOf(p);
      r.segment<2>(2 * k) = across * (p - to.PointAt(t));
      by_from.middleRows<2>(2 * k) =
          across * turn_ * ShiftJacobian(from, from_form, places[static_cast<std::size_t>(k)]);
      by_to.middleRows<2>(2 * k) = across * ShiftJacobian(to, to_form, t);
      J.middleRows<2>(2 * k) = across * PointByPose(p);
    }
    const Eigen::Matrix4d covariance =
        Spread(by_from, pair.in_query.information) + Spread(by_to, pair.in_candidate.information);
    return Whiten<4>(covariance, r, derivative ? &J : nullptr, out);
  }

  bool operator()(const AlignmentProblem::Sighting& sighting,
                  bool derivative,
                  Residual& out) const {
    const Similarity3& seen_from_known = sighting.known_to_query ? s_ : inverse_;
    const Eigen::Vector3d p = seen_from_known * sighting.point.place;
    if (!(p.z() > kNearest)) return false;
    const double scale = seen_from_known.scale;
    const Eigen::Matrix3d turn = scale * seen_from_known.rotation.toRotationMatrix();
    Eigen::Matrix3d J_p = ViewJacobian(camera_, p);
    J_p.row(2) *= camera_.baseline;
    Eigen::Vector3d view = View(camera_, p);
    view.z() *= camera_.baseline;
    const PointMeasurement& seen = sighting.measurement;
    const Eigen::Vector3d measured(seen.px.x() - camera_.cx,
                                   seen.px.y() - camera_.cy,
                                   seen.disparity ? seen.disparity->px : view.z());
    // exp(x) moves the query's points. In the query's frame it moves the candidate's points the
    // other way.
    Eigen::Matrix<double, 3, 7> J = J_p * PointByPose(p);
    if (!sighting.known_to_query) J = -J_p * turn * PointByPose(sighting.point.place);
    const Eigen::Matrix3d J_turned = J_p * turn;
    Eigen::Matrix3d covariance = J_turned * sighting.point.covariance * J_turned.transpose();
    covariance.diagonal().head<2>().array() += seen.sigma_px * seen.sigma_px;
    const Eigen::Vector3d r = view - measured;
    if (seen.disparity) {
      covariance(2, 2) += seen.disparity->sigma_px * seen.disparity->sigma_px;
      return Whiten<3>(covariance, r, derivative ? &J : nullptr, out);
    }
    const Eigen::Matrix<double, 2, 7> J_px = J.topRows<2>();
    return Whiten<2>(
        covariance.topLeftCorner<2, 2>(), r.head<2>(), derivative ? &J_px : nullptr, out);
  }

 private:
  static Eigen::Matrix4d Spread(const Eigen::Matrix4d& J, const Eigen::Matrix4d& information) {
    return J * RegularizedInformation(information).llt().solve(J.transpose());
  }

  // Returns two parameters along the query's line: the ends of the overlap of both intervals, or
  // those of its own interval if they overlap too little.
  std::array<double, 2> PlacesOnBoth(const LandmarkPair<LineModel>& pair) const {
    const LineModel& query = pair.in_query;
    const LineModel& candidate = pair.in_candidate;
    const auto place = [&](double t) {
      return query.line.ParameterOf(inverse_ * candidate.line.PointAt(t));
    };
    const double start = std::max(query.start, place(candidate.start));
    const double end = std::min(query.end, place(candidate.end));
    if (end - start > 0.1 * (query.end - query.start)) return {start, end};
    return {query.start, query.end};
  }

  const RectifiedCamera& camera_;
  const Similarity3& s_;
  Similarity3 inverse_;
  Eigen::Matrix3d turn_;
};

// The normal equations of all matches that agree.
struct Equations {
  Matrix7d H = Matrix7d::Zero();
  Vector7d g = Vector7d::Zero();
  double chi2 = 0;
  int rows = 0;
  int matches = 0;

  void Add(const Residual& residual) {
    const double squared = residual.r.squaredNorm();
    const double weight = HuberWeight(squared, kHuber);
    H.noalias() += weight * residual.J.transpose() * residual.J;
    g.noalias() += weight * residual.J.transpose() * residual.r;
    chi2 += squared;
    rows += residual.rows;
    ++matches;
  }
};

template <class Match>
void AddAll(const Evaluator& evaluate,
            const std::vector<Match>& matches,
            double gate,
            std::vector<bool>& agree,
            Equations& equations) {
  agree.assign(matches.size(), false);
  for (std::size_t i = 0; i < matches.size(); ++i) {
    Residual residual;
    if (!evaluate(matches[i], true, residual)) continue;
    if (residual.r.squaredNorm() > gate * Chi2Limit95(residual.rows)) continue;
    agree[i] = true;
    equations.Add(residual);
  }
}

Equations Linearize(const AlignmentProblem& problem, double gate, AlignmentResult& at) {
  const Evaluator evaluate(problem.camera, at.candidate_from_query);
  Equations equations;
  AddAll(evaluate, problem.points, gate, at.points, equations);
  AddAll(evaluate, problem.lines, gate, at.lines, equations);
  AddAll(evaluate, problem.sightings, gate, at.sightings, equations);
  return equations;
}

// The alignment as RANSAC needs it. Matches are the points, then the lines.
class MatchProblem {
 public:
  using Model = Similarity3;
  static constexpr std::size_t kSampleSize = 3;

  explicit MatchProblem(const AlignmentProblem& problem) : problem_(problem) {}

  std::size_t size() const { return problem_.points.size() + problem_.lines.size(); }

  std::vector<Model> Solve(const std::array<std::size_t, kSampleSize>& sample) const {
    std::vector<LandmarkPair<CameraPoint>> points;
    std::vector<LandmarkPair<LineModel>> lines;
    for (const std::size_t i : sample) {
      if (i < problem_.points.size()) {
        points.push_back(problem_.points[i]);
      } else {
        lines.push_back(problem_.lines[i - problem_.points.size()]);
      }
    }
    const auto model = AlignSample(points, lines, problem_.free_scale);
    return model ? std::vector<Model>{*model} : std::vector<Model>{};
  }

  double Cost(const Model& model, double limit) const {
    const Evaluator evaluate(problem_.camera, model);
    double cost = 0;
    for (const auto& pair : problem_.points) {
      cost += Loss(evaluate, pair);
      if (cost > limit) return cost;
    }
    for (const auto& pair : problem_.lines) {
      cost += Loss(evaluate, pair);
      if (cost > limit) return cost;
    }
    return cost;
  }

  double InlierRatio(const Model& model) const {
    const Evaluator evaluate(problem_.camera, model);
    double inliers = 0;
    for (const auto& pair : problem_.points) inliers += Loss(evaluate, pair) < 1;
    for (const auto& pair : problem_.lines) inliers += Loss(evaluate, pair) < 1;
    return inliers / static_cast<double>(size());
  }

  Model Improve(const Model& model) const {
    const auto refined = RefineAlignment(problem_, model, kGate);
    return refined ? refined->candidate_from_query : model;
  }
  bool Same(const Model&, const Model&) const { return true; }

 private:
  // The gate is wide, because predictions of a sample contain the sample's own errors.
  static constexpr double kGate = 4;

  template <class Match>
  double Loss(const Evaluator& evaluate, const Match& match) const {
    Residual residual;
    if (!evaluate(match, false, residual)) return 1;
    return std::min(1.0, residual.r.squaredNorm() / (kGate * Chi2Limit95(residual.rows)));
  }

  const AlignmentProblem& problem_;
};

// Sums target * source^T over normalized pairs of vectors.
class TurnedVectors {
 public:
  void Add(const Eigen::Vector3d& source, const Eigen::Vector3d& target) {
    const double lengths = source.norm() * target.norm();
    if (lengths > 0) sum_ += target * source.transpose() / lengths;
  }

  // Returns nullopt if the vectors are collinear.
  std::optional<Eigen::Quaterniond> Rotation() const {
    constexpr double kLeast = 1e-3;
    const RotationFit fit = FitRotation(sum_);
    if (!(fit.singular_values(1) > kLeast * fit.singular_values(0))) return std::nullopt;
    return Eigen::Quaterniond(fit.rotation).normalized();
  }

 private:
  Eigen::Matrix3d sum_ = Eigen::Matrix3d::Zero();
};

// Returns the vector from the line to the point, perpendicular to the line.
Eigen::Vector3d Perpendicular(const PluckerLine& line, const Eigen::Vector3d& point) {
  return point - line.PointAt(line.ParameterOf(point));
}

Eigen::Vector3d Middle(const LineModel& line) {
  return line.line.PointAt(0.5 * (line.start + line.end));
}

// The rows of the linear equations for [translation, scale].
class LinearEquations {
 public:
  template <int kRows>
  void Add(const Eigen::Matrix<double, kRows, 3>& across,
           const Eigen::Vector3d& turned_source,
           const Eigen::Vector3d& target,
           double weight) {
    Eigen::Matrix<double, kRows, 4> A;
    A << across, across * turned_source;
    H_ += weight * A.transpose() * A;
    g_ += weight * A.transpose() * (across * target);
  }

  std::optional<Eigen::Vector4d> Solve(bool free_scale) const {
    constexpr double kLeast = 1e-9;
    const int size = free_scale ? 4 : 3;
    Eigen::VectorXd g = g_.head(size);
    if (!free_scale) g -= H_.topRightCorner<3, 1>();
    const Eigen::LDLT<Eigen::MatrixXd> factor(H_.topLeftCorner(size, size));
    const Eigen::VectorXd D = factor.vectorD();
    if (!(D.minCoeff() > kLeast * D.maxCoeff())) return std::nullopt;
    Eigen::Vector4d solution(0, 0, 0, 1);
    solution.head(size) = factor.solve(g);
    return solution;
  }

 private:
  Eigen::Matrix4d H_ = Eigen::Matrix4d::Zero();
  Eigen::Vector4d g_ = Eigen::Vector4d::Zero();
};

}  // namespace

std::optional<Similarity3> AlignByRansac(const AlignmentProblem& problem, std::uint64_t seed) {
  AlignmentProblem matches = problem;
  matches.sightings.clear();
  const MatchProblem ransac_problem(matches);
  Rng rng(seed, "loop_alignment");
  const auto best = Ransac<MatchProblem>(ransac_problem, 300, 1).Run({}, rng);
  if (best.empty()) return std::nullopt;
  return best.front().model;
}

std::optional<AlignmentResult> RefineAlignment(const AlignmentProblem& problem,
                                               const Similarity3& near,
                                               double gate) {
  constexpr int kMaxIterations = 10;
  constexpr double kTolerance = 1e-7;
  constexpr double kLeastInformation = 1e-10;
  const int size = problem.free_scale ? 7 : 6;
  AlignmentResult result;
  result.candidate_from_query = near;
  for (int i = 0; i < kMaxIterations; ++i) {
    const Equations equations = Linearize(problem, gate, result);
    if (equations.matches < 3) return std::nullopt;
    const Eigen::MatrixXd H = equations.H.topLeftCorner(size, size);
    const Eigen::LDLT<Eigen::MatrixXd> factor(H);
    if (factor.info() != Eigen::Success ||
        !(factor.vectorD().minCoeff() > kLeastInformation * factor.vectorD().maxCoeff())) {
      return std::nullopt;
    }
    Vector7d step = Vector7d::Zero();
    step.head(size) = -factor.solve(equations.g.head(size));
    if (!step.allFinite() || std::abs(step(6)) > 2) return std::nullopt;
    const int degrees = std::max(1, equations.rows - size);
    // Mean squared whitened residual of the matches that agree.
    const double variance_factor = equations.chi2 / degrees;
    result.covariance.topLeftCorner(size, size) =
        std::max(1.0, variance_factor) * factor.solve(Eigen::MatrixXd::Identity(size, size));
    result.candidate_from_query = RetractLeft(result.candidate_from_query, step);
    result.candidate_from_query.rotation.normalize();
    if (step.norm() < kTolerance) break;
  }
  return result;
}

std::optional<Similarity3> AlignSample(std::span<const LandmarkPair<CameraPoint>> points,
                                       std::span<const LandmarkPair<LineModel>> lines,
                                       bool free_scale) {
  TurnedVectors vectors;
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      vectors.Add(points[i].in_query.place - points[j].in_query.place,
                  points[i].in_candidate.place - points[j].in_candidate.place);
    }
    for (const auto& line : lines) {
      vectors.Add(Perpendicular(line.in_query.line, points[i].in_query.place),
                  Perpendicular(line.in_candidate.line, points[i].in_candidate.place));
    }
  }
  for (const auto& line : lines) {
    vectors.Add(line.in_query.line.direction, line.in_candidate.line.direction);
  }
  const auto rotation = vectors.Rotation();
  if (!rotation) return std::nullopt;
  LinearEquations equations;
  // Weights fall with the depth, because errors of depth grow with it.
  const auto weight = [](const Eigen::Vector3d& target) { return 1 / target.squaredNorm(); };
  for (const auto& pair : points) {
    equations.Add<3>(Eigen::Matrix3d::Identity(),
                     *rotation * pair.in_query.place,
                     pair.in_candidate.place,
                     weight(pair.in_candidate.place));
  }
  for (const auto& pair : lines) {
    equations.Add<2>(BasisAcross(pair.in_candidate.line.direction).transpose(),
                     *rotation * Middle(pair.in_query),
                     Middle(pair.in_candidate),
                     weight(Middle(pair.in_candidate)));
  }
  const auto solution = equations.Solve(free_scale);
  if (!solution || !((*solution)(3) > 0) || !solution->allFinite()) return std::nullopt;
  return Similarity3{(*solution)(3), *rotation, solution->head<3>()};
}

}  // namespace plumbline

// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/tracking/line_cutting.h"

#include "plumbline/base/random.h"
#include "plumbline/geometry/plucker.h"
#include "plumbline/optimization/pose_only.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

constexpr double kSigmaPx = 0.7;

RectifiedCamera Camera() {
  return {.fx = 450, .fy = 440, .cx = 370, .cy = 240, .baseline = 0.1, .width = 752, .height = 480};
}

// Lines in front of a camera at the origin of the world, seen without errors in both images; the
// start of each is known far better than its end.
struct Scene {
  std::vector<LineModel> models;
  std::vector<CutCandidate> candidates;
  PoseProblem problem;

  explicit Scene(LineResidualKind residual = LineResidualKind::kObservedEnds, int lines = 12) {
    problem.camera = Camera();
    problem.line_residual = residual;
    Rng rng(5, "line_cutting");
    for (int i = 0; i < lines; ++i) models.push_back(RandomLine(rng));
    for (int i = 0; i < lines; ++i) AddMatches(i);
  }

  static LineModel RandomLine(Rng& rng) {
    const auto point = [&] {
      return Eigen::Vector3d(rng.Uniform(-2, 2), rng.Uniform(-1, 1), rng.Uniform(4, 7));
    };
    const Eigen::Vector3d start = point(), end = point();
    LineModel model;
    model.line = LineThroughPoints(start, end);
    model.start = model.line.ParameterOf(start);
    model.end = model.line.ParameterOf(end);
    model.information = 1e4 * Eigen::Matrix4d::Identity();
    // A point near the start is known to millimetres: the line turns about it.
    const OrthonormalLine orthonormal = ToOrthonormal(model.line);
    const Eigen::Matrix<double, 6, 4> J = HomogeneousJacobian(orthonormal);
    const Eigen::Matrix<double, 3, 4> about =
        (J.topRows<3>() - Skew(start) * J.bottomRows<3>()) / orthonormal.w.y();
    model.information += 1e6 * about.transpose() * about;
    return model;
  }

  void AddMatches(int i) {
    const LineModel& model = models[static_cast<std::size_t>(i)];
    for (const bool right : {false, true}) {
      const Eigen::Vector3d shift(right ? -problem.camera.baseline : 0.0, 0, 0);
      PoseProblem::LineMatch match;
      match.line_in_world = model.line;
      match.ends = model.Interval();
      match.measurement.segment = {problem.camera.Project(match.ends.start + shift),
                                   problem.camera.Project(match.ends.end + shift)};
      match.measurement.covariance = kSigmaPx * kSigmaPx * Eigen::Matrix2d::Identity();
      match.measurement.camera = right ? 1 : 0;
      match.group = i;
      problem.lines.push_back(match);
      candidates.push_back({&model, kSigmaPx});
    }
  }

  PoseProblem Cut(CuttingMethod method,
                  LineWeighting weighting = LineWeighting::kNone,
                  CuttingInformation information = CuttingInformation::kIndependent,
                  int budget = 0) const {
    LineOptions lines;
    lines.residual = problem.line_residual;
    lines.weighting = weighting;
    CuttingOptions cutting{.method = method, .information = information};
    cutting.budget = budget;
    return WithCutLines(problem, candidates, lines, cutting);
  }
};

// Of the place across the line of a point at parameter t.
Eigen::Vector3d AcrossAt(const PluckerLine& line, const PluckerLine& moved, double t) {
  const Eigen::Vector3d p = line.PointAt(t);
  const Eigen::Vector3d q = moved.PointAt(moved.ParameterOf(p));
  return (q - p) - line.direction * line.direction.dot(q - p);
}

TEST(CovariancesOfEnds, AreThoseOfRandomLinesWithThatInformation) {
  const Scene scene;
  const LineModel& model = scene.models[0];
  const OrthonormalLine orthonormal = ToOrthonormal(model.line);
  const Eigen::Matrix4d covariance = model.information.inverse();
  const Eigen::Matrix4d root = covariance.llt().matrixL();
  Rng rng(3, "ends");
  Eigen::Matrix3d start = Eigen::Matrix3d::Zero(), end = start;
  constexpr int kSamples = 20000;
  constexpr double kScale = 1e-3;  // so small that the line moves linearly
  for (int i = 0; i < kSamples; ++i) {
    Eigen::Vector4d unit;
    for (int k = 0; k < 4; ++k) unit(k) = rng.Normal();
    const PluckerLine moved = ToPlucker(Retract(orthonormal, kScale * (root * unit)));
    const Eigen::Vector3d a = AcrossAt(model.line, moved, model.start) / kScale;
    const Eigen::Vector3d b = AcrossAt(model.line, moved, model.end) / kScale;
    start += a * a.transpose() / kSamples;
    end += b * b.transpose() / kSamples;
  }
  const Rigid3 pose{ExpSo3({0.3, -0.2, 0.1}), {1, 2, 3}};
  const EndCovariances ends = CovariancesOfEnds(pose, model, LineInterval{model.start, model.end});
  const Eigen::Matrix3d R = pose.rotation.toRotationMatrix();
  const Eigen::Vector3d& d = model.line.direction;
  const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - d * d.transpose();
  for (const auto& [found, sampled] : {std::pair{ends.start, start}, std::pair{ends.end, end}}) {
    const Eigen::Matrix3d in_world = R.transpose() * found * R;
    EXPECT_LT((across * in_world * across - sampled).norm(), 0.05 * sampled.norm());
    EXPECT_NEAR(d.dot(in_world * d), sampled.trace(), 0.05 * sampled.trace());
  }
  EXPECT_LT(start.trace(), 0.1 * end.trace());  // as the scene says
}

TEST(WithCutLines, KeepsThePoseOfExactMeasurements) {
  for (const auto residual : {LineResidualKind::kObservedEnds, LineResidualKind::kProjectedEnds}) {
    const Scene scene(residual);
    for (const auto method : {CuttingMethod::kGreedy,
                              CuttingMethod::kGreedySweeps,
                              CuttingMethod::kJoint,
                              CuttingMethod::kDrop}) {
      for (const auto weighting :
           {LineWeighting::kNone, LineWeighting::kScalar, LineWeighting::kCovariance}) {
        PoseProblem cut = scene.Cut(method, weighting);
        cut.cam_from_world =
            ExpSe3((Vector6d() << 0.004, -0.003, 0.002, 0.01, -0.02, 0.01).finished());
        const PoseOnlyResult result = SolvePose(cut);
        EXPECT_TRUE(result.converged);
        EXPECT_LT(LogSe3(result.cam_from_world).norm(), 1e-4)
            << NameOf(method) << " " << NameOf(weighting) << " " << NameOf(residual);
      }
    }
  }
}

TEST(WithCutLines, CutsTowardsTheEndThatIsKnown) {
  const Scene scene(LineResidualKind::kProjectedEnds);
  const PoseProblem cut = scene.Cut(CuttingMethod::kGreedySweeps);
  ASSERT_EQ(cut.lines.size(), scene.problem.lines.size());
  int shorter = 0;
  double ratio_sum = 0;
  for (std::size_t i = 0; i < cut.lines.size(); ++i) {
    const Segment3& whole = scene.problem.lines[i].ends;
    const Segment3& piece = cut.lines[i].ends;
    EXPECT_EQ(cut.lines[i].group, scene.problem.lines[i].group);
    EXPECT_LT(Distance(whole, piece.start) + Distance(whole, piece.end), 1e-6);
    shorter += piece.Length() < 0.99 * whole.Length();
    ratio_sum += (piece.Midpoint() - whole.start).norm() / whole.Length();
  }
  EXPECT_GT(shorter, static_cast<int>(cut.lines.size()) / 2);
  EXPECT_LT(ratio_sum / static_cast<double>(cut.lines.size()), 0.4);
}

TEST(WithCutLines, MovesMeasuredEndsToWhereThePieceShows) {
  const Scene observed(LineResidualKind::kObservedEnds);
  const Scene projected(LineResidualKind::kProjectedEnds);
  const PoseProblem moved = observed.Cut(CuttingMethod::kGreedy);
  const PoseProblem pieces = projected.Cut(CuttingMethod::kGreedy);
  for (std::size_t i = 0; i < moved.lines.size(); ++i) {
    const LineMeasurement& measurement = moved.lines[i].measurement;
    const Eigen::Vector3d shift(observed.problem.camera.ShiftInto(measurement.camera), 0, 0);
    const Segment3& piece = pieces.lines[i].ends;
    const RectifiedCamera& camera = observed.problem.camera;
    EXPECT_LT((measurement.segment.start - camera.Project(piece.start + shift)).norm(), 1e-6);
    EXPECT_LT((measurement.segment.end - camera.Project(piece.end + shift)).norm(), 1e-6);
  }
}

TEST(WithCutLines, WeightsPiecesAsAsked) {
  const Scene scene(LineResidualKind::kProjectedEnds);
  const PoseProblem none = scene.Cut(CuttingMethod::kGreedy);
  const PoseProblem scalar = scene.Cut(CuttingMethod::kGreedy, LineWeighting::kScalar);
  const PoseProblem full = scene.Cut(CuttingMethod::kGreedy, LineWeighting::kCovariance);
  int pieces = 0;
  for (std::size_t i = 0; i < none.lines.size(); ++i) {
    const bool whole = none.lines[i].ends.Length() == scene.problem.lines[i].ends.Length();
    if (whole) continue;
    EXPECT_EQ(none.lines[i].measurement.covariance, Eigen::Matrix2d::Identity());
    const Eigen::Matrix2d& two = full.lines[i].measurement.covariance;
    EXPECT_EQ(two(0, 1), 0);
    EXPECT_GE(two.diagonal().minCoeff(), kSigmaPx * kSigmaPx);  // the floor
    const Eigen::Matrix2d& one = scalar.lines[i].measurement.covariance;
    EXPECT_NEAR(one(0, 0), 0.5 * two.trace(), 1e-9 * two.trace());
    EXPECT_EQ(one(0, 0), one(1, 1));
    ++pieces;
  }
  EXPECT_GT(pieces, 10);
}

TEST(WithCutLines, DropLeavesLinesOutInBothImages) {
  const Scene scene;
  const PoseProblem cut = scene.Cut(CuttingMethod::kDrop);
  // 0.3 of 12 lines are 3.
  EXPECT_EQ(cut.lines.size(), scene.problem.lines.size() - 6);
  for (std::size_t i = 0; i < cut.lines.size(); i += 2) {
    EXPECT_EQ(cut.lines[i].group, cut.lines[i + 1].group);
    EXPECT_EQ(cut.lines[i].measurement.covariance, scene.problem.lines[0].measurement.covariance);
  }
}

TEST(WithCutLines, LeavesShortLinesWhole) {
  Scene scene;
  LineMeasurement& left = scene.problem.lines[0].measurement;
  left.segment.end = left.segment.start + Eigen::Vector2d(3, 2);
  const PoseProblem cut = scene.Cut(CuttingMethod::kGreedy);
  EXPECT_EQ(cut.lines[0].measurement.segment.end, left.segment.end);
  EXPECT_EQ(cut.lines[1].measurement.segment.end, scene.problem.lines[1].measurement.segment.end);
}

TEST(WithCutLines, KeepsToTheBudget) {
  Scene scene;
  Rng rng(8, "points of a budget");
  for (int i = 0; i < 30; ++i) {
    const Eigen::Vector3d place(rng.Uniform(-2, 2), rng.Uniform(-1.5, 1.5), rng.Uniform(2, 7));
    scene.problem.points.push_back({place, {scene.problem.camera.Project(place), kSigmaPx, {}}});
  }
  PoseProblem chosen = scene.Cut(CuttingMethod::kGreedy, LineWeighting::kNone, {}, 15);
  std::set<int> groups;
  for (const auto& match : chosen.lines) groups.insert(match.group);
  EXPECT_EQ(chosen.points.size() + groups.size(), 15U);
  EXPECT_EQ(chosen.lines.size(), 2 * groups.size());
  EXPECT_FALSE(chosen.points.empty());
  EXPECT_FALSE(groups.empty());
  chosen.cam_from_world =
      ExpSe3((Vector6d() << 0.004, -0.003, 0.002, 0.01, -0.02, 0.01).finished());
  EXPECT_LT(LogSe3(SolvePose(chosen).cam_from_world).norm(), 1e-4);
  // A budget that is not reached changes nothing.
  const PoseProblem all = scene.Cut(CuttingMethod::kNone, LineWeighting::kNone, {}, 42);
  EXPECT_EQ(all.points.size(), 30U);
  EXPECT_EQ(all.lines.size(), scene.problem.lines.size());
}

TEST(PointsThatFit, LeavesOutWhatIsFarOrBehind) {
  Scene scene;
  const RectifiedCamera& camera = scene.problem.camera;
  const Eigen::Vector3d place(0.3, -0.2, 3);
  const Eigen::Vector2d px = camera.Project(place);
  const Disparity disparity{camera.fx * camera.baseline / place.z(), 1};
  auto& points = scene.problem.points;
  points.push_back({place, {px, 1, {}}});
  points.push_back({place, {px + Eigen::Vector2d(4, 0), 1, {}}});
  points.push_back({place, {px + Eigen::Vector2d(4, 0), 2, {}}});
  points.push_back({place, {px, 1, disparity}});
  points.push_back({place, {px, 1, Disparity{disparity.px + 4, 1}}});
  points.push_back({-place, {px, 1, {}}});
  EXPECT_EQ(PointsThatFit(scene.problem, Rigid3{}, 1),
            (std::vector<bool>{true, false, true, true, false, false}));
  EXPECT_EQ(PointsThatFit(scene.problem, Rigid3{}, 10),
            (std::vector<bool>{true, true, true, true, true, false}));
}

TEST(LinesThatFit, JudgesBothImagesTogether) {
  for (const auto residual : {LineResidualKind::kObservedEnds, LineResidualKind::kProjectedEnds}) {
    Scene scene(residual);
    // Of 12 lines one is off by five sigmas in the right image.
    for (Eigen::Vector2d* px : {&scene.problem.lines[5].measurement.segment.start,
                                &scene.problem.lines[5].measurement.segment.end}) {
      const Eigen::Vector2d along = scene.problem.lines[4].measurement.segment.Direction();
      *px += 5 * kSigmaPx * Eigen::Vector2d(-along.y(), along.x());
    }
    const std::vector<bool> fits = LinesThatFit(scene.problem, Rigid3{}, 1);
    EXPECT_EQ(std::count(fits.begin(), fits.end(), false), 2);
    EXPECT_FALSE(fits[4]);
    EXPECT_FALSE(fits[5]);
    EXPECT_EQ(std::count(fits.begin(), fits.end(), true), 22);
    const std::vector<bool> lax = LinesThatFit(scene.problem, Rigid3{}, 100);
    EXPECT_EQ(std::count(lax.begin(), lax.end(), false), 0);
  }
}

}  // namespace
}  // namespace plumbline

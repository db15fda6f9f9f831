// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/random.h"
#include "plumbline/geometry/plucker.h"
#include "plumbline/matching/line_method.h"
#include "plumbline/tracking/line_cutting.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include <Eigen/Core>
#include <gtest/gtest.h>

namespace plumbline::testing {

inline constexpr double kSigmaPx = 0.7;

// Lines in front of a camera at the origin of the world, seen without errors in both images; the
// start of each is known far better than its end.
struct CutScene {
  std::vector<LineModel> models;
  std::vector<CutCandidate> candidates;
  PoseProblem problem;
  LineMethod line_method;

  explicit CutScene(const LineMethod& of_lines = {}, int lines = 12) : line_method(of_lines) {
    problem.camera = {
        .fx = 450, .fy = 440, .cx = 370, .cy = 240, .baseline = 0.1, .width = 752, .height = 480};
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

  PoseProblem Cut(LineWeighting weighting = LineWeighting::kNone,
                  const CuttingSettings& cutting = {{.method = "greedy"}}) const {
    return WithCutLines(problem, candidates, {{.weighting = weighting}, line_method}, cutting);
  }
};

inline void ExpectPoseOfCutLines(const LineMethod& lines,
                                 const CuttingSettings& cutting = {{.method = "greedy"}}) {
  const CutScene scene(lines);
  for (const auto weighting :
       {LineWeighting::kNone, LineWeighting::kScalar, LineWeighting::kCovariance}) {
    PoseProblem cut = scene.Cut(weighting, cutting);
    cut.cam_from_world = ExpSe3((Vector6d() << 0.004, -0.003, 0.002, 0.01, -0.02, 0.01).finished());
    const PoseOnlyResult result = lines.solve_pose(cut, {});
    EXPECT_TRUE(result.converged);
    EXPECT_LT(LogSe3(result.cam_from_world).norm(), 1e-4)
        << cutting.method << " " << NameOf(weighting);
  }
}

inline void ExpectBothImagesJudgedTogether(const LineMethod& lines) {
  CutScene scene(lines);
  // Of 12 lines one is off by five sigmas in the right image.
  for (Eigen::Vector2d* px : {&scene.problem.lines[5].measurement.segment.start,
                              &scene.problem.lines[5].measurement.segment.end}) {
    const Eigen::Vector2d along = scene.problem.lines[4].measurement.segment.Direction();
    *px += 5 * kSigmaPx * Eigen::Vector2d(-along.y(), along.x());
  }
  const std::vector<bool> fits = LinesThatFit(scene.problem, lines, Rigid3{}, 1);
  EXPECT_EQ(std::count(fits.begin(), fits.end(), false), 2);
  EXPECT_FALSE(fits[4]);
  EXPECT_FALSE(fits[5]);
  EXPECT_EQ(std::count(fits.begin(), fits.end(), true), 22);
  const std::vector<bool> lax = LinesThatFit(scene.problem, lines, Rigid3{}, 100);
  EXPECT_EQ(std::count(lax.begin(), lax.end(), false), 0);
}

}  // namespace plumbline::testing

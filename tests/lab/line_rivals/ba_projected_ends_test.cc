// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/line_rivals/ba_projected_ends.h"

#include "tests/optimization/random_scene.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::Random;
using testing::RandomMeasuredSegment;
using testing::StereoCamera;

// Half the squared norm of an observation's residual, as a function of the landmark's update and
// the pose's, has the gradient that Add() gives; and V, H and W are J^T J of numeric J.
template <class Kind>
void ExpectAddMatchesCentralDifferences(const typename Kind::State& state,
                                        const BaPose& pose,
                                        const LineMeasurement& m) {
  constexpr int kDof = Kind::kDof;
  constexpr double kStep = 1e-6;
  const RectifiedCamera camera = StereoCamera();
  const auto term = Kind::MakeTerm(camera, m);
  const auto residual = [&](const BaPose& p, const typename Kind::State& s) {
    const Segment3 place = Kind::MakePlace(s);
    Eigen::Vector2d r;
    const Rigid3& T = p.cam_from_world;
    EXPECT_TRUE(WhitenedEndDistances(term, {T * place.start, T * place.end}, r));
    return r;
  };
  Eigen::Matrix<double, 2, kDof> J;
  for (int k = 0; k < kDof; ++k) {
    const Eigen::Matrix<double, kDof, 1> step = kStep * Eigen::Matrix<double, kDof, 1>::Unit(k);
    J.col(k) =
        (residual(pose, Kind::Retract(state, step)) - residual(pose, Kind::Retract(state, -step))) /
        (2 * kStep);
  }
  Eigen::Matrix<double, 2, 6> A;
  for (int k = 0; k < 6; ++k) {
    BaPose above, below;
    above.Set(RetractLeft(pose.cam_from_world, kStep * Vector6d::Unit(k)));
    below.Set(RetractLeft(pose.cam_from_world, -kStep * Vector6d::Unit(k)));
    A.col(k) = (residual(above, state) - residual(below, state)) / (2 * kStep);
  }
  const Eigen::Vector2d r = residual(pose, state);
  LandmarkEquations<kDof> landmark;
  PoseEquations equations;
  Eigen::Matrix<double, 6, kDof> W = Eigen::Matrix<double, 6, kDof>::Zero();
  ASSERT_TRUE(
      Kind::Add(camera, pose, Kind::MakeView(state), term, 1e9, {landmark, &equations, &W}));
  const auto near = [](const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
    EXPECT_LT((a - b).norm(), 1e-5 * (1 + b.norm())) << a << "\nexpected\n" << b;
  };
  near(landmark.V, J.transpose() * J);
  near(landmark.g, J.transpose() * r);
  near(equations.H, A.transpose() * A);
  near(equations.g, A.transpose() * r);
  near(W, A.transpose() * J);
  EXPECT_NEAR(Kind::Chi2(camera, pose, Kind::MakePlace(state), term), r.squaredNorm(), 1e-9);
}

TEST(BaProjectedEnds, AddsTheProductsOfTheJacobians) {
  Random random(1);
  for (int i = 0; i < 20; ++i) {
    const auto [cam_from_world, ends, m] = RandomMeasuredSegment(random, i % 2 == 0);
    BaPose pose;
    pose.Set(cam_from_world);
    const PluckerLine line = LineThroughPoints(ends.start, ends.end);
    const LineWithEnds with_ends{ToOrthonormal(line),
                                 {line.ParameterOf(ends.start), line.ParameterOf(ends.end)}};
    ExpectAddMatchesCentralDifferences<BaProjectedEnds>(ends, pose, m);
    ExpectAddMatchesCentralDifferences<BaProjectedLine<BaLine>>(with_ends, pose, m);
    ExpectAddMatchesCentralDifferences<BaProjectedLine<BaLineLeft>>(with_ends, pose, m);
  }
}

// The two halves together are the whole.
TEST(BaLineEnd, TwoOfThemAddWhatTheWholeLineAdds) {
  Random random(2);
  const RectifiedCamera camera = StereoCamera();
  for (int i = 0; i < 20; ++i) {
    auto [cam_from_world, ends, m] = RandomMeasuredSegment(random, i % 2 == 0);
    BaPose pose;
    pose.Set(cam_from_world);
    m.covariance << 2, 0, 0, 0.5;
    LandmarkEquations<6> whole;
    PoseEquations pose_whole, pose_parts;
    Eigen::Matrix<double, 6, 6> W = Eigen::Matrix<double, 6, 6>::Zero();
    ASSERT_TRUE(BaProjectedEnds::Add(camera,
                                     pose,
                                     BaProjectedEnds::MakeView(ends),
                                     BaProjectedEnds::MakeTerm(camera, m),
                                     1e9,
                                     {whole, &pose_whole, &W}));
    const auto terms = BaLineEnd::MakeTerms(camera, m);
    double chi2 = 0;
    for (const int k : {0, 1}) {
      LandmarkEquations<3> part;
      Eigen::Matrix<double, 6, 3> W_part = Eigen::Matrix<double, 6, 3>::Zero();
      const BaLineEnd::State state{k == 0 ? ends.start : ends.end, ends.end - ends.start};
      ASSERT_TRUE(BaLineEnd::Add(camera, pose, state, terms[k], 1e9, {part, &pose_parts, &W_part}));
      EXPECT_LT((part.V - whole.V.block<3, 3>(3 * k, 3 * k)).norm(), 1e-9 * whole.V.norm());
      EXPECT_LT((part.g - whole.g.segment<3>(3 * k)).norm(), 1e-9 * whole.g.norm());
      EXPECT_LT((W_part - W.middleCols<3>(3 * k)).norm(), 1e-9 * W.norm());
      chi2 += BaLineEnd::Chi2(camera, pose, state.point, terms[k]);
    }
    EXPECT_EQ((whole.V.block<3, 3>(3, 0).norm()), 0);
    EXPECT_LT((pose_parts.H - pose_whole.H).norm(), 1e-9 * pose_whole.H.norm());
    EXPECT_LT((pose_parts.g - pose_whole.g).norm(), 1e-9 * pose_whole.g.norm());
    EXPECT_NEAR(BaProjectedEnds::Chi2(camera, pose, ends, BaProjectedEnds::MakeTerm(camera, m)),
                chi2,
                1e-8);
  }
}

TEST(BaProjectedEnds, BehindTheCameraAddsNothingAndCostsInfinitelyMuch) {
  const RectifiedCamera camera = StereoCamera();
  LineMeasurement m;
  m.segment = {{100, 100}, {200, 150}};
  const Segment3 ends{{0, 0, -1}, {1, 0, 4}};
  const auto term = BaProjectedEnds::MakeTerm(camera, m);
  LandmarkEquations<6> landmark;
  EXPECT_FALSE(BaProjectedEnds::Add(
      camera, {}, BaProjectedEnds::MakeView(ends), term, 1, {landmark, nullptr, nullptr}));
  EXPECT_EQ(landmark.V.norm(), 0);
  EXPECT_TRUE(std::isinf(BaProjectedEnds::Chi2(camera, {}, ends, term)));
}

}  // namespace
}  // namespace plumbline

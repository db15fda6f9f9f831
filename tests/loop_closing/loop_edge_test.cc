// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/loop_closing/loop_edge.h"

#include "tests/support/random_geometry.h"
#include <limits>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

LoopEdge MakeEdge() {
  LoopEdge edge;
  edge.query = KeyFrameId{1};
  edge.candidate = KeyFrameId{0};
  edge.candidate_from_query = {1.2, ExpSo3({0.1, 0.2, -0.1}), {0.5, -0.4, 0.3}};
  edge.query_scale = 2;
  edge.candidate_scale = 3;
  return edge;
}

TEST(LoopEdge, FollowsTheUnitsOfItsKeyFrames) {
  const LoopEdge edge = MakeEdge();
  const Eigen::Vector3d then(1, 2, 3);
  // Lengths around the query are half of what they were, those around the candidate double.
  const Similarity3 today = CandidateFromQueryToday(edge, 1, 6);
  EXPECT_LT((today * (0.5 * then) - 2 * (edge.candidate_from_query * then)).norm(), 1e-12);
}

TEST(LoopEdge, InformationIsTheInverseOfTheCovariance) {
  Rng rng(1, "loop_edge");
  LoopEdge edge = MakeEdge();
  Matrix7d A;
  for (int i = 0; i < 7; ++i) A.col(i) = RandomVector<7>(rng);
  edge.covariance = A * A.transpose() + Matrix7d::Identity();
  EXPECT_TRUE((InformationOf(edge) * edge.covariance).isIdentity(1e-9));
  edge.covariance.row(6).setZero();
  edge.covariance.col(6).setZero();
  Matrix7d rigid = Matrix7d::Identity();
  rigid(6, 6) = 0;
  EXPECT_TRUE((InformationOf(edge) * edge.covariance).isApprox(rigid, 1e-9));
}

TEST(LoopEdge, TakesOneWorldToTheOther) {
  LoopEdge edge = MakeEdge();
  Rng rng(2, "loop_edge");
  Map query_map;
  Map candidate_map;
  const auto add = [](Map& map, std::int64_t id, const Rigid3& pose) {
    KeyFrame keyframe;
    keyframe.id = KeyFrameId{id};
    keyframe.frame.cam_from_world = pose;
    keyframe.frame.indexed = std::make_shared<FrameFeatures>();
    map.Apply({edit::AddKeyFrame{keyframe}});
  };
  add(query_map, 1, RandomRigid(rng));
  add(candidate_map, 0, RandomRigid(rng));
  edge.query_scale = edge.candidate_scale = 1;
  const Similarity3 worlds = CandidateWorldFromQueryWorld(query_map, candidate_map, edge);
  const Eigen::Vector3d place(0.3, 0.4, 2);  // in the query's camera
  const Eigen::Vector3d in_query_world = Inverse(query_map.PoseOf(edge.query)) * place;
  EXPECT_LT((candidate_map.PoseOf(edge.candidate) * (worlds * in_query_world) -
             edge.candidate_from_query * place)
                .norm(),
            1e-12);
}

}  // namespace

namespace pose_with_covariance_test {

PoseWithCovariance RandomPose(Rng& rng, double sigma) {
  PoseWithCovariance pose;
  const Rigid3 rigid = RandomRigid(rng);
  pose.pose = {1 + rng.Uniform(-0.3, 0.3), rigid.rotation, rigid.translation};
  Matrix7d A;
  for (int i = 0; i < 7; ++i) A.col(i) = RandomVector<7>(rng, sigma);
  pose.covariance = A * A.transpose();
  return pose;
}

Similarity3 Sample(const PoseWithCovariance& pose, Rng& rng) {
  const Matrix7d L = pose.covariance.llt().matrixL();
  return RetractLeft(pose.pose, L * RandomVector<7>(rng));
}

// The covariance of samples about the composition is the one computed.
TEST(PoseWithCovariance, ComposesAsSamplesDo) {
  Rng rng(3, "uncertain_pose");
  const PoseWithCovariance a = RandomPose(rng, 1e-3);
  const PoseWithCovariance b = RandomPose(rng, 1e-3);
  const PoseWithCovariance both = Compose(a, b);
  double chi2 = 0;
  constexpr int kSamples = 2000;
  for (int i = 0; i < kSamples; ++i) {
    const Similarity3 sample = Sample(a, rng) * Sample(b, rng);
    chi2 += ClosingChi2({sample * Inverse(both.pose), both.covariance}) / kSamples;
  }
  EXPECT_NEAR(chi2, 7, 0.4);
}

TEST(PoseWithCovariance, InvertsAsSamplesDo) {
  Rng rng(4, "uncertain_pose");
  const PoseWithCovariance a = RandomPose(rng, 1e-3);
  const PoseWithCovariance inverse = Inverse(a);
  double chi2 = 0;
  constexpr int kSamples = 2000;
  for (int i = 0; i < kSamples; ++i) {
    chi2 += ClosingChi2({Inverse(Sample(a, rng)) * Inverse(inverse.pose), inverse.covariance}) /
            kSamples;
  }
  EXPECT_NEAR(chi2, 7, 0.4);
}

TEST(PoseWithCovariance, RigidOnesHaveSixDegreesOfFreedom) {
  PoseWithCovariance pose;
  pose.covariance.diagonal().head<6>().setConstant(0.01);
  pose.pose.translation = {0.1, 0, 0};
  EXPECT_NEAR(ClosingChi2(pose), 1, 1e-9);
  pose.covariance.setZero();
  EXPECT_EQ(ClosingChi2(pose), std::numeric_limits<double>::infinity());
}

}  // namespace pose_with_covariance_test

}  // namespace plumbline

// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/loop_closing/loop_edge.h"

#include "tests/support/random_geometry.h"

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
}  // namespace plumbline

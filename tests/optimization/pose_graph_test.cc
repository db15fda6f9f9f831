// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/optimization/pose_graph.h"

#include "plumbline/base/error.h"

#include "tests/support/random_geometry.h"
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

Matrix7d Information(double sigma) { return Matrix7d::Identity() / (sigma * sigma); }

// Cameras around a circle, tied one to the next, with poses that drift away from what the last
// edge, from the last to the first, says.
struct Ring {
  std::vector<Similarity3> truth;
  PoseGraph graph;

  Ring(int count, PoseGraphMotion motion, std::uint64_t seed = 1) {
    graph.motion = motion;
    Rng rng(seed, "ring");
    const bool rigid = motion == PoseGraphMotion::kRigid;
    for (int i = 0; i < count; ++i) {
      const double angle = 2 * std::numbers::pi * i / count;
      const Eigen::Vector3d centre(5 * std::cos(angle), 0, 5 * std::sin(angle));
      truth.push_back(ToSimilarity(Inverse(Rigid3{ExpSo3({0, -angle, 0}), centre})));
    }
    graph.poses.push_back(truth.front());
    for (int i = 1; i < count; ++i) {
      Vector7d error = RandomVector<7>(rng, 0.01);
      if (rigid) error(6) = 0;
      AddEdge(i, i - 1, error, 0.01);
      graph.poses.push_back(graph.edges.back().to_from * graph.poses.back());
    }
    graph.fixed.assign(graph.poses.size(), false);
    graph.fixed.front() = true;
    AddEdge(0, count - 1, Vector7d::Zero(), 0.001);
    graph.edges.back().may_be_wrong = true;
  }

  void AddEdge(int to, int from, const Vector7d& error, double sigma) {
    PoseGraphEdge edge;
    edge.to = to;
    edge.from = from;
    edge.to_from = RetractLeft(
        truth[static_cast<std::size_t>(to)] * Inverse(truth[static_cast<std::size_t>(from)]),
        error);
    edge.information = Information(sigma);
    graph.edges.push_back(edge);
  }

  double Error(const std::vector<Similarity3>& poses) const {
    double sum = 0;
    for (std::size_t i = 0; i < poses.size(); ++i) {
      sum += LogSim3(poses[i] * Inverse(truth[i])).squaredNorm();
    }
    return std::sqrt(sum / static_cast<double>(poses.size()));
  }
};

double Cost(const PoseGraph& graph, const std::vector<Similarity3>& poses) {
  double cost = 0;
  for (const PoseGraphEdge& edge : graph.edges) {
    const Vector7d r = PoseGraphResidual(
        edge, poses[static_cast<std::size_t>(edge.to)], poses[static_cast<std::size_t>(edge.from)]);
    cost += r.dot(edge.information * r);
  }
  return cost;
}

TEST(PoseGraph, ClosesARing) {
  for (const auto motion : {PoseGraphMotion::kRigid, PoseGraphMotion::kSimilarity}) {
    const Ring ring(40, motion);
    const PoseGraphResult result = SolvePoseGraph(ring.graph);
    EXPECT_TRUE(result.converged);
    EXPECT_LT(result.chi2.back(), 1);
    EXPECT_LT(ring.Error(result.poses), ring.Error(ring.graph.poses));
    const auto off = [&](const std::vector<Similarity3>& poses) {
      return LogSim3(poses.back() * Inverse(ring.truth.back())).norm();
    };
    EXPECT_LT(off(result.poses), 0.1 * off(ring.graph.poses));
    EXPECT_EQ(result.poses.front().translation, ring.truth.front().translation);
  }
}

TEST(PoseGraph, KeepsRigidPosesRigid) {
  const Ring ring(20, PoseGraphMotion::kRigid);
  for (const Similarity3& pose : SolvePoseGraph(ring.graph).poses) EXPECT_EQ(pose.scale, 1);
}

// No small step from the solution lowers the cost.
TEST(PoseGraph, IsAtAMinimum) {
  const Ring ring(12, PoseGraphMotion::kSimilarity);
  const PoseGraphResult result = SolvePoseGraph(ring.graph);
  const double cost = Cost(ring.graph, result.poses);
  for (std::size_t i = 1; i < result.poses.size(); ++i) {
    for (int k = 0; k < 7; ++k) {
      for (const double step : {-1e-4, 1e-4}) {
        auto poses = result.poses;
        poses[i] = RetractLeft(poses[i], step * Vector7d::Unit(k));
        EXPECT_GE(Cost(ring.graph, poses), cost);
      }
    }
  }
}

// One that says less than the rest does; a firmer one bends the rest.
TEST(PoseGraph, LeavesOutAWrongLoop) {
  Ring ring(40, PoseGraphMotion::kRigid);
  Vector7d wrong = Vector7d::Zero();
  wrong.segment<3>(3) << 3, 1, -2;
  ring.AddEdge(5, 25, wrong, 0.3);
  ring.graph.edges.back().may_be_wrong = true;
  const PoseGraphResult result = SolvePoseGraph(ring.graph);
  EXPECT_TRUE(result.converged);
  EXPECT_EQ(result.weights.back(), 0);
  EXPECT_EQ(result.weights[result.weights.size() - 2], 1);
  const Ring without(40, PoseGraphMotion::kRigid);
  EXPECT_NEAR(ring.Error(result.poses), ring.Error(SolvePoseGraph(without.graph).poses), 1e-4);
}

TEST(PoseGraph, BelievesEdgesThatCannotBeWrong) {
  Ring ring(10, PoseGraphMotion::kRigid);
  Vector7d wrong = Vector7d::Zero();
  wrong.segment<3>(3) << 3, 1, -2;
  ring.AddEdge(2, 7, wrong, 0.001);
  EXPECT_EQ(SolvePoseGraph(ring.graph).weights.back(), 1);
}

TEST(PoseGraph, LeavesWhatNothingTiesWhereItIs) {
  Ring ring(10, PoseGraphMotion::kRigid);
  const Similarity3 alone{1, ExpSo3({1, 0, 0}), {7, 8, 9}};
  ring.graph.poses.push_back(alone);
  ring.graph.fixed.push_back(false);
  const PoseGraphResult result = SolvePoseGraph(ring.graph);
  EXPECT_TRUE(result.converged);
  EXPECT_LT((result.poses.back().translation - alone.translation).norm(), 1e-12);
}

TEST(PoseGraph, WithAllFixedChangesNothing) {
  Ring ring(5, PoseGraphMotion::kRigid);
  ring.graph.fixed.assign(5, true);
  const PoseGraphResult result = SolvePoseGraph(ring.graph);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(result.poses[i].translation, ring.graph.poses[i].translation);
  }
}

TEST(PoseGraph, WantsAFlagForEachPose) {
  Ring ring(5, PoseGraphMotion::kRigid);
  ring.graph.fixed.pop_back();
  EXPECT_THROW(SolvePoseGraph(ring.graph), BugError);
}

TEST(PoseGraph, GivesTheSameEveryTime) {
  const Ring ring(30, PoseGraphMotion::kSimilarity);
  const auto a = SolvePoseGraph(ring.graph).poses;
  const auto b = SolvePoseGraph(ring.graph).poses;
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_EQ(a[i].translation, b[i].translation);
}

}  // namespace
}  // namespace plumbline

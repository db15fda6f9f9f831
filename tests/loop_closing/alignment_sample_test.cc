// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/loop_closing/alignment_sample.h"

#include "plumbline/map/motion.h"

#include "tests/support/random_geometry.h"
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

struct Sample {
  Similarity3 truth;
  std::vector<AlignmentProblem::PointPair> points;
  std::vector<AlignmentProblem::LinePair> lines;

  Sample(Rng& rng, double scale) {
    const Rigid3 rigid = RandomRigid(rng);
    truth = {scale, rigid.rotation, rigid.translation};
  }

  Eigen::Vector3d Place(Rng& rng) { return RandomVector<3>(rng) + Eigen::Vector3d(0, 0, 5); }

  Sample& AddPoint(Rng& rng) {
    const Eigen::Vector3d place = Place(rng);
    points.push_back({{place}, {truth * place}});
    return *this;
  }
  Sample& AddLine(Rng& rng) { return AddLine(Place(rng), Place(rng)); }
  Sample& AddLine(const Eigen::Vector3d& start, const Eigen::Vector3d& end) {
    LineModel line;
    line.line = LineThroughPoints(start, end);
    line.start = line.line.ParameterOf(start);
    line.end = line.line.ParameterOf(end);
    line.information.setIdentity();
    LineModel moved = line;
    Move(truth, moved);
    lines.push_back({line, moved});
    return *this;
  }

  // How far the solution is from the truth; large where there is none.
  double Error(bool free_scale) const {
    const auto solution = AlignSample(points, lines, free_scale);
    return solution ? LogSim3(*solution * Inverse(truth)).norm() : 1e9;
  }
};

TEST(AlignSample, SolvesAnyMixtureOfThree) {
  Rng rng(1, "alignment_sample");
  for (int i = 0; i < 20; ++i) {
    for (int points = 0; points <= 3; ++points) {
      for (const bool free_scale : {false, true}) {
        Sample sample(rng, free_scale ? rng.Uniform(0.5, 2) : 1);
        for (int k = 0; k < points; ++k) sample.AddPoint(rng);
        for (int k = points; k < 3; ++k) sample.AddLine(rng);
        EXPECT_LT(sample.Error(free_scale), 1e-5) << points << " points";
      }
    }
  }
}

TEST(AlignSample, KeepsTheScaleWhereItIsKnown) {
  Rng rng(2, "alignment_sample");
  Sample sample(rng, 1.3);
  sample.AddPoint(rng).AddPoint(rng).AddPoint(rng);
  EXPECT_EQ(AlignSample(sample.points, sample.lines, false)->scale, 1);
  EXPECT_NEAR(AlignSample(sample.points, sample.lines, true)->scale, 1.3, 1e-9);
}

TEST(AlignSample, RefusesWhatIsDegenerate) {
  Rng rng(3, "alignment_sample");
  Sample parallel(rng, 1);
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d start = parallel.Place(rng);
    parallel.AddLine(start, start + Eigen::Vector3d(0, 1, 0));
  }
  EXPECT_FALSE(AlignSample(parallel.points, parallel.lines, false));
  Sample row(rng, 1);
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d place(k, 0, 5);
    row.points.push_back({{place}, {row.truth * place}});
  }
  EXPECT_FALSE(AlignSample(row.points, row.lines, false));
  // Lines of one plane through a point have no scale.
  Sample fan(rng, 1);
  for (int k = 0; k < 3; ++k) fan.AddLine({0, 0, 5}, Eigen::Vector3d(1, k - 1, 5));
  EXPECT_FALSE(AlignSample(fan.points, fan.lines, true));
}

}  // namespace
}  // namespace plumbline

// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/loop_closing/landmark_alignment.h"

#include "plumbline/map/motion.h"
#include "plumbline/matching/measurements.h"

#include "tests/support/random_geometry.h"
#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

// Landmarks that two cameras know with errors of known covariance.
class Scene {
 public:
  Scene(std::uint64_t seed, bool free_scale) : rng_(seed, "landmark_alignment") {
    problem.camera = TestCamera();
    problem.free_scale = free_scale;
    truth = {free_scale ? rng_.Uniform(0.6, 1.6) : 1,
             ExpSo3(RandomVector<3>(rng_, 0.1)),
             RandomVector<3>(rng_, 0.3)};
  }

  void AddPoints(int count) {
    for (int i = 0; i < count; ++i) {
      const Eigen::Vector3d place = Place();
      problem.points.push_back({Known(place, 1), Known(truth * place, truth.scale)});
    }
  }

  void AddSightings(int count) {
    for (int i = 0; i < count; ++i) {
      const bool known_to_query = i % 2 == 0;
      const Eigen::Vector3d place = Place();
      const Eigen::Vector3d seen = known_to_query ? truth * place : place;
      const Eigen::Vector3d known = known_to_query ? place : truth * place;
      PointMeasurement measurement;
      measurement.px = problem.camera.Project(seen) + RandomVector<2>(rng_);
      if (i % 3 == 0 && !problem.free_scale) {
        measurement.disparity =
            Disparity{problem.camera.DisparityFromDepth(seen.z()) + rng_.Normal(0.5), 0.5};
      }
      problem.sightings.push_back(
          {known_to_query, Known(known, known_to_query ? 1 : truth.scale), measurement});
    }
  }

  void AddLines(int count) {
    for (int i = 0; i < count; ++i) {
      const Eigen::Vector3d start = Place();
      const Eigen::Vector3d end = start + RandomVector<3>(rng_).normalized();
      problem.lines.push_back({KnownLine(start, end), KnownLine(truth * start, truth * end)});
    }
  }

  // The last `count` point pairs show different things.
  void SpoilPoints(std::size_t count) {
    for (std::size_t i = problem.points.size() - count; i < problem.points.size(); ++i) {
      problem.points[i].in_candidate = Known(truth * Place(), truth.scale);
    }
  }

  double Nees(const AlignmentResult& result) const {
    const Eigen::Index size = problem.free_scale ? 7 : 6;
    const Eigen::VectorXd error = LogSim3(result.candidate_from_query * Inverse(truth)).head(size);
    return error.dot(result.covariance.topLeftCorner(size, size).ldlt().solve(error));
  }

  AlignmentProblem problem;
  Similarity3 truth;

 private:
  Eigen::Vector3d Place() {
    const double z = rng_.Uniform(2, 8);
    const double x = rng_.Uniform(-0.6, 0.6);
    return {x * z, rng_.Uniform(-0.4, 0.4) * z, z};
  }

  // With errors of one pixel and of the depth, drawn from the covariance.
  CameraPoint Known(const Eigen::Vector3d& place, double unit) {
    const double across = place.z() / problem.camera.fx;
    const double along = 0.01 * place.z() * place.z() / unit;
    const Eigen::Vector3d ray = place.normalized();
    const Eigen::Matrix3d covariance =
        across * across * Eigen::Matrix3d::Identity() + along * along * ray * ray.transpose();
    const Eigen::Matrix3d L = covariance.llt().matrixL();
    return {place + L * RandomVector<3>(rng_), covariance};
  }

  LineModel KnownLine(const Eigen::Vector3d& start, const Eigen::Vector3d& end) {
    LineModel line;
    line.line = LineThroughPoints(start, end);
    const OrthonormalLine form = ToOrthonormal(line.line);
    const auto place = [&](double t) { return ShiftJacobian(line.line, form, t); };
    const double sigma = 0.01 * start.norm();
    for (const Eigen::Vector3d& at : {start, end}) {
      const Eigen::Matrix<double, 3, 4> J = place(line.line.ParameterOf(at));
      line.information += J.transpose() * J / (sigma * sigma);
    }
    const Eigen::Matrix4d L = line.information.inverse().llt().matrixL();
    line.line = ToPlucker(Retract(form, L * RandomVector<4>(rng_)));
    line.start = line.line.ParameterOf(start);
    line.end = line.line.ParameterOf(end);
    return line;
  }

  Rng rng_;
};

double MeanNees(bool free_scale, int points, int lines, int sightings) {
  constexpr int kScenes = 60;
  double sum = 0;
  for (std::uint64_t seed = 0; seed < kScenes; ++seed) {
    Scene scene(seed, free_scale);
    scene.AddPoints(points);
    scene.AddLines(lines);
    scene.AddSightings(sightings);
    const auto result = RefineAlignment(scene.problem, scene.truth, 3);
    if (!result) return 1e9;
    sum += scene.Nees(*result) / kScenes;
  }
  return sum;
}

// The mean of 60 chi2 variables with six (seven) degrees of freedom deviates by 0.45 (0.48); where
// residuals are above their mean, the covariance grows, which makes the mean a little smaller.
TEST(RefineAlignment, CovarianceIsThatOfTheError) {
  EXPECT_NEAR(MeanNees(false, 60, 0, 0), 6, 1.4);
  EXPECT_NEAR(MeanNees(true, 60, 0, 0), 7, 1.5);
}

TEST(RefineAlignment, CovarianceIsThatOfTheErrorWithLines) {
  EXPECT_NEAR(MeanNees(false, 0, 30, 0), 6, 1.8);
  EXPECT_NEAR(MeanNees(true, 20, 30, 0), 7, 1.8);
}

TEST(RefineAlignment, CovarianceIsThatOfTheErrorWithSightings) {
  EXPECT_NEAR(MeanNees(false, 0, 0, 60), 6, 1.4);
  EXPECT_NEAR(MeanNees(true, 20, 0, 60), 7, 1.5);
}

TEST(RefineAlignment, TellsWhichAgree) {
  Scene scene(1, false);
  scene.AddPoints(60);
  scene.SpoilPoints(15);
  const auto result = RefineAlignment(scene.problem, scene.truth, 2);
  ASSERT_TRUE(result);
  EXPECT_GE(std::count(result->points.begin(), result->points.begin() + 45, true), 43);
  EXPECT_LE(std::count(result->points.begin() + 45, result->points.end(), true), 2);
}

TEST(RefineAlignment, RefusesWhatLeavesADirectionOpen) {
  Scene scene(2, false);
  scene.AddPoints(2);
  EXPECT_FALSE(RefineAlignment(scene.problem, scene.truth, 4));
  scene.problem.points.clear();
  EXPECT_FALSE(RefineAlignment(scene.problem, scene.truth, 4));
}

TEST(AlignByRansac, FindsThePoseAmongWrongMatches) {
  for (const bool free_scale : {false, true}) {
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
      Scene scene(seed, free_scale);
      scene.AddPoints(60);
      scene.AddLines(10);
      scene.SpoilPoints(35);
      const auto found = AlignByRansac(scene.problem, 0);
      ASSERT_TRUE(found);
      const auto refined = RefineAlignment(scene.problem, *found, 2);
      ASSERT_TRUE(refined);
      EXPECT_LT(LogSim3(refined->candidate_from_query * Inverse(scene.truth)).norm(), 0.1);
    }
  }
}

TEST(AlignByRansac, GivesTheSameForTheSameSeed) {
  Scene scene(3, true);
  scene.AddPoints(30);
  const auto a = AlignByRansac(scene.problem, 5);
  const auto b = AlignByRansac(scene.problem, 5);
  EXPECT_EQ(a->translation, b->translation);
  EXPECT_EQ(a->scale, b->scale);
}

TEST(AlignByRansac, NeedsThreeMatches) {
  Scene scene(4, false);
  scene.AddPoints(2);
  EXPECT_FALSE(AlignByRansac(scene.problem, 0));
}

struct Sample {
  Similarity3 truth;
  std::vector<LandmarkPair<CameraPoint>> points;
  std::vector<LandmarkPair<LineModel>> lines;

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

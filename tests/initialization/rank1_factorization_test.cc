// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/initialization/rank1_factorization.h"

#include "tests/support/random_geometry.h"
#include <algorithm>
#include <cmath>

#include <Eigen/SVD>
#include <gtest/gtest.h>

namespace plumbline {
namespace rank1_factorization_test {

// Cameras that move about, and what they see of a cloud of points.
struct Scene {
  std::vector<Eigen::Vector3d> points;   // in the reference frame
  std::vector<Eigen::Vector3d> centres;  // in the reference frame
  std::vector<Eigen::Vector2d> reference;
  std::vector<Rank1View> views;
};

Scene MakeScene(std::uint64_t seed, int m, int n, double sigma = 0) {
  Rng rng(seed, "scene");
  Scene scene;
  for (int k = 0; k < n; ++k) {
    scene.points.emplace_back(rng.Uniform(-1.5, 1.5), rng.Uniform(-1, 1), rng.Uniform(2, 6));
    scene.reference.push_back(scene.points.back().hnormalized() + RandomVector<2>(rng, sigma));
  }
  const Eigen::Vector3d direction = RandomVector<3>(rng).normalized();
  for (int i = 0; i < m; ++i) {
    const Eigen::Vector3d centre = 0.15 * (i + 1) * (direction + RandomVector<3>(rng, 0.2));
    Rank1View view;
    view.reference_from_cam = ExpSo3(RandomVector<3>(rng, 0.04));
    view.centre_direction = centre.normalized();
    for (const Eigen::Vector3d& p : scene.points) {
      const Eigen::Vector3d in_cam = view.reference_from_cam.conjugate() * (p - centre);
      view.points.emplace_back(in_cam.hnormalized() + RandomVector<2>(rng, sigma));
    }
    view.sigmas.assign(scene.points.size(), std::max(sigma, 1e-3));
    scene.centres.push_back(centre);
    scene.views.push_back(std::move(view));
  }
  return scene;
}

// The factor that brings the solution's centres to the true ones.
double TrueScale(const Scene& scene) {
  double sum = 0;
  for (const Eigen::Vector3d& c : scene.centres) sum += c.squaredNorm();
  return std::sqrt(sum);
}

double CentreError(const Scene& scene, const Rank1Solution& solution) {
  double sum = 0;
  for (std::size_t i = 0; i < scene.centres.size(); ++i) {
    sum += (scene.centres[i] / TrueScale(scene) - solution.centres[i]).squaredNorm();
  }
  return std::sqrt(sum);
}

TEST(Rank1Matrix, IsCentresTimesInverseDistancesWithoutNoise) {
  for (int seed = 0; seed < 10; ++seed) {
    const Scene scene = MakeScene(static_cast<std::uint64_t>(seed), 3, 60);
    const Rank1Matrix matrix(scene.reference, scene.views, 0);
    for (Eigen::Index k = 0; k < 60; ++k) {
      const double inverse = 1 / scene.points[static_cast<std::size_t>(k)].norm();
      for (Eigen::Index i = 0; i < 3; ++i) {
        const Eigen::Vector3d expected = scene.centres[static_cast<std::size_t>(i)] * inverse;
        EXPECT_LT((matrix.entries().col(k).segment<3>(3 * i) - expected).norm(), 1e-10);
      }
    }
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(matrix.entries());
    EXPECT_LT(svd.singularValues()(1) / svd.singularValues()(0), 1e-10);
  }
}

// The literal reading of eq. 1, the reference's ray turned instead of the measured one, is not rank
// one: the measured places decide (E1).
TEST(Rank1Matrix, TakesTheMeasuredRay) {
  Scene scene = MakeScene(3, 3, 60);
  for (Rank1View& view : scene.views) {
    for (std::size_t k = 0; k < scene.reference.size(); ++k) {
      const Eigen::Vector3d p = scene.reference[k].homogeneous();
      view.points[k] = p.hnormalized();
    }
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(
      Rank1Matrix(scene.reference, scene.views, 0).entries());
  EXPECT_GT(svd.singularValues()(1) / svd.singularValues()(0), 0.1);
}

TEST(Rank1Matrix, DoesNotDependOnTheSignOfADirection) {
  Scene scene = MakeScene(4, 3, 60, 1e-3);
  const Rank1Matrix matrix(scene.reference, scene.views, 0.02);
  scene.views[0].centre_direction *= -1;
  scene.views[2].centre_direction *= -1;
  const Rank1Matrix other(scene.reference, scene.views, 0.02);
  EXPECT_EQ(matrix.entries(), other.entries());
  EXPECT_EQ(matrix.weights(), other.weights());
}

TEST(Rank1Matrix, LeavesOutRaysAlongTheMotion) {
  Scene scene = MakeScene(5, 2, 40);
  // A point straight ahead of the first camera's motion: eq. 3 is singular for it there.
  const Rank1View& view = scene.views[0];
  const Eigen::Vector3d along = view.reference_from_cam.conjugate() * view.centre_direction;
  scene.views[0].points[7] = along.hnormalized();
  const Rank1Matrix matrix(scene.reference, scene.views, 0.02);
  EXPECT_EQ(matrix.weights()(0, 7), 0);
  EXPECT_GT(matrix.weights()(1, 7), 0);
  EXPECT_TRUE(matrix.entries().allFinite());
}

TEST(LeadingPair, IsThatOfASingularValueDecomposition) {
  Rng rng(6);
  for (int i = 0; i < 10; ++i) {
    Eigen::MatrixXd entries =
        Eigen::VectorXd::NullaryExpr(9, [&] { return rng.Normal(); }) *
        Eigen::RowVectorXd::NullaryExpr(50, [&] { return rng.Uniform(1, 2); });
    entries += Eigen::MatrixXd::NullaryExpr(9, 50, [&] { return rng.Normal(0.1); });
    const RankOne pair = LeadingPair(entries);
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(entries, Eigen::ComputeThinU);
    EXPECT_NEAR(std::abs(svd.matrixU().col(0).dot(pair.centres)), 1, 1e-12);
    EXPECT_NEAR(pair.inverse_distances.norm(), svd.singularValues()(0), 1e-9);
    EXPECT_GT((pair.inverse_distances.array() > 0).count(), 25);
  }
}

TEST(FactorizeRank1, IsExactWithoutNoiseAndSeesPointsInFront) {
  for (int seed = 0; seed < 200; ++seed) {
    const Scene scene = MakeScene(static_cast<std::uint64_t>(seed), 3, 60);
    // With a few entries left out at the epipoles it takes more steps.
    const auto solution = FactorizeRank1(scene.reference, scene.views, {.iterations = 30});
    ASSERT_TRUE(solution);
    EXPECT_LT(CentreError(scene, *solution), 1e-9) << seed;
    for (std::size_t k = 0; k < scene.points.size(); ++k) {
      EXPECT_NEAR(solution->inverse_distances[k] * scene.points[k].norm(), TrueScale(scene), 1e-9);
    }
    EXPECT_EQ(solution->in_front, 60);
    EXPECT_EQ(solution->solved, 60);
  }
}

// The places of every third point in the middle frame are missing: reweighted least squares
// completes what a decomposition cannot.
TEST(FactorizeRank1, CompletesWhatIsMissing) {
  Scene scene = MakeScene(8, 3, 90);
  for (std::size_t k = 0; k < 90; k += 3) scene.views[1].sigmas[k] = 0;
  const auto solution = FactorizeRank1(scene.reference, scene.views, {.iterations = 60});
  ASSERT_TRUE(solution);
  EXPECT_LT(CentreError(scene, *solution), 1e-9);
}

// One tenth of the entries is wrong: the plain factorization is off by a tenth, the reweighted one
// as good as without them (E1, eq. 5).
TEST(FactorizeRank1, ReweightsOutliersAway) {
  double plain = 0;
  double robust = 0;
  double clean = 0;
  constexpr int kScenes = 40;
  for (int seed = 0; seed < kScenes; ++seed) {
    Scene scene = MakeScene(static_cast<std::uint64_t>(seed), 3, 200, 0.5 / 520);
    clean += CentreError(scene, *FactorizeRank1(scene.reference, scene.views)) / kScenes;
    Rng rng(7, "outliers", static_cast<std::uint64_t>(seed));
    for (Rank1View& view : scene.views) {
      for (int j = 0; j < 20; ++j) {
        view.points[rng.Index(200)] +=
            Eigen::Vector2d(rng.Uniform(-0.1, 0.1), rng.Uniform(-.1, .1));
      }
    }
    const auto solve = [&](int iterations) {
      return CentreError(scene,
                         *FactorizeRank1(scene.reference, scene.views, {.iterations = iterations}));
    };
    plain += solve(0) / kScenes;
    robust += solve(10) / kScenes;
  }
  EXPECT_GT(plain, 0.02);
  EXPECT_LT(robust, 0.2 * plain);
  EXPECT_LT(robust, 3 * clean);
}

TEST(FactorizeRank1, MeasuresTheNoise) {
  Scene scene = MakeScene(9, 4, 400, 1e-3);
  const auto solution = FactorizeRank1(scene.reference, scene.views);
  ASSERT_TRUE(solution);
  // Two rays of one deviation make an entry, which is the mean of two lines' nearest points.
  EXPECT_GT(solution->spread, 0.3);
  EXPECT_LT(solution->spread, 1.5);
}

TEST(FactorizeRank1, RefusesWhatCannotBeSolved) {
  Scene scene = MakeScene(10, 2, 20);
  EXPECT_FALSE(FactorizeRank1(scene.reference, {}));
  std::fill(scene.views[1].sigmas.begin(), scene.views[1].sigmas.end(), 0.0);
  EXPECT_FALSE(FactorizeRank1(scene.reference, scene.views));
}

}  // namespace rank1_factorization_test
}  // namespace plumbline

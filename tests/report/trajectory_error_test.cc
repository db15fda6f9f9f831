// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/report/trajectory_error.h"

#include "plumbline/base/error.h"
#include "plumbline/base/random.h"
#include "plumbline/report/figure.h"
#include "plumbline/report/trajectory_figure.h"

#include "tests/support/random_geometry.h"
#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

using Eigen::Vector3d;
using testing::HasSubstr;

constexpr std::int64_t kSecond = 1'000'000'000;

StampedPose At(double seconds,
               const Vector3d& position,
               const Vector3d& rotation = Vector3d::Zero()) {
  return {std::llround(seconds * 1e9), {ExpSo3(rotation), position}};
}

Trajectory RandomTrajectory(Rng& rng, int count, double spacing_s) {
  Trajectory trajectory;
  const auto vector = [&rng](double size) {
    return Vector3d(rng.Normal(size), rng.Normal(size), rng.Normal(size));
  };
  for (int i = 0; i < count; ++i) trajectory.push_back(At(i * spacing_s, vector(1), vector(1)));
  return trajectory;
}

Trajectory Perturbed(const Trajectory& trajectory, Rng& rng, double size) {
  Trajectory noisy = trajectory;
  for (StampedPose& pose : noisy) {
    Vector6d tangent;
    for (double& value : tangent) value = rng.Normal(size);
    pose.world_from_camera = RetractLeft(pose.world_from_camera, tangent);
  }
  return noisy;
}

TEST(TrajectoryError, StatisticsByHand) {
  const auto odd = StatisticsOf({3, 0, 4});
  ASSERT_TRUE(odd);
  EXPECT_EQ(odd->count, 3U);
  EXPECT_DOUBLE_EQ(odd->rmse, std::sqrt(25.0 / 3));
  EXPECT_DOUBLE_EQ(odd->mean, 7.0 / 3);
  EXPECT_DOUBLE_EQ(odd->median, 3);
  EXPECT_DOUBLE_EQ(odd->max, 4);
  // Population: (2/3)^2 + (7/3)^2 + (5/3)^2 over three. Percentiles between 3 and 4.
  EXPECT_DOUBLE_EQ(odd->deviation, std::sqrt(78.0 / 27));
  EXPECT_DOUBLE_EQ(odd->p75, 3.5);
  EXPECT_DOUBLE_EQ(odd->p95, 3.9);
  EXPECT_DOUBLE_EQ(StatisticsOf({4, 1, 2, 9})->median, 3);
  EXPECT_DOUBLE_EQ(StatisticsOf({7})->p95, 7);
  EXPECT_FALSE(StatisticsOf({}));
}

TEST(TrajectoryError, UnalignedPositionsByHand) {
  const Trajectory reference = {At(0, {0, 0, 0}), At(1, {1, 0, 0}), At(2, {2, 0, 0})};
  const Trajectory estimate = {At(0, {0, 0, 0}), At(1, {1, 0.3, 0}), At(2, {2, 0, 0.4})};
  const auto error =
      CompareTrajectories(reference, estimate, {.alignment = TrajectoryAlignment::kNone});
  ASSERT_TRUE(error);
  EXPECT_NEAR(error->ate.rmse, std::sqrt(0.25 / 3), 1e-15);
  EXPECT_NEAR(error->ate.mean, 0.7 / 3, 1e-15);
  EXPECT_NEAR(error->ate.max, 0.4, 1e-15);
  EXPECT_EQ(error->poses.size(), 3U);
}

TEST(TrajectoryError, AlignedPositionsByHand) {
  const Trajectory reference = {
      At(0, {1, 0, 0}), At(1, {-1, 0, 0}), At(2, {0, 1, 0}), At(3, {0, -1, 0})};
  Trajectory estimate = reference;
  // A quarter turn and a shift of the whole; then a symmetric stretch along z that no motion
  // undoes.
  const Rigid3 moved{ExpSo3({0, 0, 0.5 * std::numbers::pi}), {5, -2, 7}};
  constexpr double kBend = 0.1;
  for (std::size_t i = 0; i < estimate.size(); ++i) {
    Rigid3 pose = estimate[i].world_from_camera;
    pose.translation.z() += i < 2 ? kBend : -kBend;
    estimate[i].world_from_camera = moved * pose;
  }
  const auto error = CompareTrajectories(reference, estimate, {});
  ASSERT_TRUE(error);
  EXPECT_FALSE(error->degenerate);
  EXPECT_NEAR(error->ate.rmse, kBend, 1e-12);
  EXPECT_NEAR(error->ate.max, kBend, 1e-12);
  EXPECT_NEAR((error->reference_from_estimate.rotation * moved.rotation)
                  .angularDistance(Eigen::Quaterniond::Identity()),
              0,
              1e-12);
}

TEST(TrajectoryError, RelativeErrorsByHand) {
  // The reference stands still; the estimate drifts 0.2 m along x and turns 0.1 rad in 2 s, then
  // rests for another.
  const Trajectory reference = {
      At(0, {1, 2, 3}), At(1, {1, 2, 3}), At(2, {1, 2, 3}), At(3, {1, 2, 3})};
  const Trajectory estimate = {At(0, {0, 0, 0}),
                               At(1, {0.1, 0, 0}, {0.05, 0, 0}),
                               At(2, {0.2, 0, 0}, {0.1, 0, 0}),
                               At(3, {0.2, 0, 0}, {0.1, 0, 0})};
  TrajectoryErrorOptions options{.alignment = TrajectoryAlignment::kNone};
  options.window.duration_ns = 2 * kSecond;
  auto error = CompareTrajectories(reference, estimate, options);
  ASSERT_TRUE(error && error->rpe && error->roe);
  EXPECT_EQ(error->rpe->count, 2U);  // 0 -> 2 s: 0.2 m; 1 -> 3 s: 0.1 m
  EXPECT_NEAR(error->rpe->mean, 0.075, 1e-12);
  EXPECT_NEAR(error->rpe->rmse, std::sqrt((0.01 + 0.0025) / 2), 1e-12);
  EXPECT_NEAR(error->roe->mean, 0.0375, 1e-12);

  options.window = {.frames = 1};
  error = CompareTrajectories(reference, estimate, options);
  ASSERT_TRUE(error && error->rpe);
  EXPECT_EQ(error->rpe->count, 3U);
  EXPECT_NEAR(error->rpe->mean, 0.2 / 3, 1e-12);
  EXPECT_NEAR(error->rpe->max, 0.1, 1e-12);
  EXPECT_NEAR(error->roe->max, 0.05, 1e-12);
}

TEST(TrajectoryError, RelativeErrorIsDividedByTheActualTime) {
  const Trajectory reference = {At(0, {0, 0, 0}), At(1.02, {0, 0, 0})};
  const Trajectory estimate = {At(0, {0, 0, 0}), At(1.02, {0.51, 0, 0})};
  TrajectoryErrorOptions options{.alignment = TrajectoryAlignment::kNone};
  options.window.duration_ns = kSecond;
  options.max_gap_ns = 2 * kSecond;
  const auto error = CompareTrajectories(reference, estimate, options);
  ASSERT_TRUE(error && error->rpe);
  EXPECT_NEAR(error->rpe->mean, 0.5, 1e-12);
  options.window.duration_ns = 11 * kSecond / 10;  // 7 % off: no pair
  EXPECT_FALSE(CompareTrajectories(reference, estimate, options)->rpe);
}

TEST(TrajectoryError, FrameWindowsDoNotSpanLostFrames) {
  Trajectory reference, estimate;
  for (int i = 0; i < 10; ++i) {
    reference.push_back(At(0.1 * i, {1.0 * i, 0, 0}));
    if (i != 4 && i != 5) estimate.push_back(reference.back());
  }
  TrajectoryErrorOptions options{.alignment = TrajectoryAlignment::kNone};
  options.window = {.frames = 1};
  const auto error = CompareTrajectories(reference, estimate, options);
  ASSERT_TRUE(error && error->rpe);
  EXPECT_EQ(error->rpe->count, 6U);  // 7 steps, one of them over the gap
}

TEST(TrajectoryError, AlignmentMakesErrorsInvariantToTheWorld) {
  Rng rng(1);
  const Trajectory reference = RandomTrajectory(rng, 60, 0.1);
  const Trajectory estimate = Perturbed(reference, rng, 0.02);
  TrajectoryErrorOptions options;
  options.window.duration_ns = kSecond;
  const auto plain = CompareTrajectories(reference, estimate, options);
  const Rigid3 moved{ExpSo3({0.3, -1, 2}), {4, 5, -6}};
  Trajectory other = estimate;
  for (StampedPose& pose : other) pose.world_from_camera = moved * pose.world_from_camera;
  const auto aligned = CompareTrajectories(reference, other, options);
  ASSERT_TRUE(plain && aligned && plain->rpe && aligned->rpe);
  EXPECT_GT(plain->ate.rmse, 0.01);
  EXPECT_NEAR(aligned->ate.rmse, plain->ate.rmse, 1e-12);
  EXPECT_NEAR(aligned->rpe->rmse, plain->rpe->rmse, 1e-12);
  EXPECT_NEAR(aligned->roe->rmse, plain->roe->rmse, 1e-12);
  options.alignment = TrajectoryAlignment::kNone;
  EXPECT_GT(CompareTrajectories(reference, other, options)->ate.rmse, 1);
}

TEST(TrajectoryError, Sim3TakesOutTheScaleAlsoOfRelativeErrors) {
  Rng rng(2);
  const Trajectory reference = RandomTrajectory(rng, 40, 0.1);
  Trajectory estimate = reference;
  for (StampedPose& pose : estimate) pose.world_from_camera.translation *= 0.25;
  TrajectoryErrorOptions options{.alignment = TrajectoryAlignment::kSim3};
  options.window = {.frames = 1};
  const auto error = CompareTrajectories(reference, estimate, options);
  ASSERT_TRUE(error && error->rpe);
  EXPECT_NEAR(error->reference_from_estimate.scale, 4, 1e-12);
  EXPECT_LT(error->ate.max, 1e-12);
  EXPECT_LT(error->rpe->max, 1e-10);
  options.alignment = TrajectoryAlignment::kSe3;
  EXPECT_GT(CompareTrajectories(reference, estimate, options)->rpe->mean, 1);
}

// Fifty poses, the steps of the last ten longer than those of the first by `drift`.
std::vector<EvaluatedPose> DriftingPoses(const Eigen::Vector3d& bend, double drift) {
  std::vector<EvaluatedPose> poses(50);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const auto t = static_cast<double>(i);
    poses[i].reference.translation = {t, bend.x() * t * t, bend.y() * std::sin(t)};
    const double scale = i < 40 ? 3 : 3 * (1 + drift);
    poses[i].estimate.translation = ExpSo3({1, 2, 3}) * (scale * poses[i].reference.translation);
  }
  return poses;
}

TEST(ScaleDrift, IsOfTheLastFifthAgainstTheFirst) {
  for (const Eigen::Vector3d& bend : {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(0.1, 2, 0)}) {
    const auto drift = ScaleDrift(DriftingPoses(bend, 0.07));
    ASSERT_TRUE(drift);
    EXPECT_NEAR(*drift, 0.07, 1e-12);
  }
  EXPECT_NEAR(*ScaleDrift(DriftingPoses({0, 1, 0}, -0.2)), -0.2, 1e-12);
}

TEST(ScaleDrift, IsUnknownWhereTheCameraStaysAtTheEnd) {
  std::vector<EvaluatedPose> poses = DriftingPoses({0, 0, 0}, 0.1);
  for (std::size_t i = 40; i < 50; ++i) poses[i].reference = poses[40].reference;
  EXPECT_FALSE(ScaleDrift(poses));
  EXPECT_FALSE(ScaleDrift(std::span(poses).first(4)));
  EXPECT_FALSE(ScaleDrift({}));
}

TEST(ScaleDrift, IsComparedWithAFreeScaleOnly) {
  Rng rng(3);
  const Trajectory reference = RandomTrajectory(rng, 40, 0.1);
  TrajectoryErrorOptions options{.alignment = TrajectoryAlignment::kSim3};
  const auto error = CompareTrajectories(reference, reference, options);
  ASSERT_TRUE(error && error->scale_drift);
  EXPECT_NEAR(*error->scale_drift, 0, 1e-12);
  options.alignment = TrajectoryAlignment::kSe3;
  EXPECT_FALSE(CompareTrajectories(reference, reference, options)->scale_drift);
}

TEST(TrajectoryError, InterpolationMeetsTheTimeThatNearestMisses) {
  Trajectory reference;
  for (int i = 0; i < 20; ++i) reference.push_back(At(0.03 * i, {0.3 * i, 0, 0}));
  const Trajectory estimate = {At(0.1, {1, 0, 0}), At(0.205, {2.05, 0, 0})};
  TrajectoryErrorOptions options{.alignment = TrajectoryAlignment::kNone};
  EXPECT_LT(CompareTrajectories(reference, estimate, options)->ate.max, 1e-12);
  options.association = TrajectoryAssociation::kNearest;
  const auto nearest = CompareTrajectories(reference, estimate, options);
  ASSERT_TRUE(nearest);
  EXPECT_NEAR(nearest->ate.max, 0.1, 1e-12);     // reference of 0.09 s for 0.1 s
  EXPECT_NEAR(nearest->ate.mean, 0.075, 1e-12);  // and 0.21 s for 0.205 s
  options.max_difference_ns = kSecond / 200;
  EXPECT_EQ(CompareTrajectories(reference, estimate, options)->poses.size(), 1U);
}

TEST(TrajectoryError, PosesInGapsOfTheReferenceAreLeftOut) {
  const Trajectory reference = {At(0, {0, 0, 0}), At(0.1, {1, 0, 0}), At(0.3, {3, 0, 0})};
  const Trajectory estimate = {
      At(-0.1, {0, 0, 0}), At(0.05, {0.5, 0, 0}), At(0.2, {2, 0, 0}), At(0.3, {3, 0, 0})};
  TrajectoryErrorOptions options{.alignment = TrajectoryAlignment::kNone};
  auto error = CompareTrajectories(reference, estimate, options);
  ASSERT_TRUE(error);
  EXPECT_EQ(error->estimated, 4U);
  ASSERT_EQ(error->poses.size(), 2U);
  EXPECT_EQ(error->poses[0].row, 1U);
  EXPECT_EQ(error->poses[1].row, 3U);
  options.max_gap_ns = kSecond / 4;
  EXPECT_EQ(CompareTrajectories(reference, estimate, options)->poses.size(), 3U);
  EXPECT_FALSE(CompareTrajectories(reference, {At(9, {0, 0, 0})}, options));
  EXPECT_FALSE(CompareTrajectories({}, estimate, options));
}

TEST(TrajectoryError, DegenerateAlignmentsAreReported) {
  const Rigid3 moved{ExpSo3({1, 2, 0.5}), {4, 5, 6}};
  Trajectory line, still;
  for (int i = 0; i < 5; ++i) {
    line.push_back(At(i, {2.0 * i, 1.0 * i, 0}));
    still.push_back(At(i, {1, 2, 3}));
  }
  const auto other = [&moved](Trajectory trajectory, double scale) {
    for (StampedPose& pose : trajectory) {
      pose.world_from_camera.translation *= scale;
      pose.world_from_camera = moved * pose.world_from_camera;
    }
    return trajectory;
  };
  TrajectoryErrorOptions options{.alignment = TrajectoryAlignment::kSim3};
  auto error = CompareTrajectories(line, other(line, 0.5), options);
  ASSERT_TRUE(error && error->degenerate);
  EXPECT_EQ(*error->degenerate, AlignmentFailure::kCollinear);
  EXPECT_NEAR(error->reference_from_estimate.scale, 2, 1e-9);
  EXPECT_LT(error->ate.max, 1e-9);
  error = CompareTrajectories(still, other(still, 1), options);
  ASSERT_TRUE(error && error->degenerate);
  EXPECT_EQ(*error->degenerate, AlignmentFailure::kCoincident);
  EXPECT_DOUBLE_EQ(error->reference_from_estimate.scale, 1);
  EXPECT_LT(error->ate.max, 1e-9);
  error = CompareTrajectories({line[0]}, {line[0]}, {});
  ASSERT_TRUE(error && error->degenerate);
  EXPECT_EQ(*error->degenerate, AlignmentFailure::kTooFewPoints);
  EXPECT_FALSE(error->rpe);
}

// A straight road on which the estimate wanders by 1 cm. Least squares of the positions tell all
// but the turn about the road, whatever the orientations say of its direction.
TEST(TrajectoryError, StraightPathsAreAlignedByAllPositions) {
  Trajectory road, estimate;
  for (int i = 0; i < 200; ++i) {
    const Vector3d wander(std::sin(1.3 * i), std::cos(2.1 * i), std::sin(0.7 * i));
    road.push_back(At(i, {0, 0, 0.5 * i}));
    // The first orientation is off by half a degree.
    estimate.push_back(At(i, Vector3d(0, 0, 0.5 * i) + 0.01 * wander, {i == 0 ? 0.01 : 0.0, 0, 0}));
  }
  for (const auto alignment : {TrajectoryAlignment::kSe3, TrajectoryAlignment::kSim3}) {
    const auto error = CompareTrajectories(road, estimate, {.alignment = alignment});
    ASSERT_TRUE(error && error->degenerate);
    EXPECT_LT(error->ate.rmse, 0.0125);
    // A wobble of a tenth of a millimetre gives the road a second direction. It is far below what
    // the estimate is off, so that it must not change the error.
    Trajectory wobbly = road;
    for (std::size_t i = 0; i < wobbly.size(); ++i) {
      wobbly[i].world_from_camera.translation.x() += 1e-4 * static_cast<double>(i % 2);
    }
    const auto determined = CompareTrajectories(wobbly, estimate, {.alignment = alignment});
    ASSERT_TRUE(determined && !determined->degenerate);
    EXPECT_NEAR(error->ate.rmse, determined->ate.rmse, 1e-3);
    EXPECT_NEAR(
        error->reference_from_estimate.scale, determined->reference_from_estimate.scale, 1e-5);
  }
}

// A path without extent has no scale, and none that drifts, wherever it lies.
TEST(TrajectoryError, APathInOnePlaceHasNoScale) {
  Trajectory path, still;
  for (int i = 0; i < 20; ++i) {
    path.push_back(At(i, {0.1 * i, 0.01 * i * i, 0}));
    still.push_back(At(i, {1, 1, 1}));
  }
  const auto error = CompareTrajectories(path, still, {.alignment = TrajectoryAlignment::kSim3});
  ASSERT_TRUE(error && error->degenerate);
  EXPECT_DOUBLE_EQ(error->reference_from_estimate.scale, 1);
  EXPECT_FALSE(error->scale_drift);
}

TEST(TrajectoryError, BodyAndCameraDifferByTheLeverArm) {
  const Rigid3 body_from_camera{ExpSo3({0.1, 0.2, 0.3}), {0.05, 0, 0}};
  const Trajectory body = {At(0, {1, 2, 3}, {0, 0, 0.5 * std::numbers::pi})};
  const Trajectory camera = OfCamera(body, body_from_camera);
  EXPECT_NEAR((camera[0].world_from_camera.translation - Vector3d(1, 2.05, 3)).norm(), 0, 1e-15);
  EXPECT_NEAR(AngularDistance(camera[0].world_from_camera.rotation,
                              body[0].world_from_camera.rotation * body_from_camera.rotation),
              0,
              1e-15);
}

TEST(TrajectoryError, MirrorConjugatesThePose) {
  Rng rng(3);
  const Trajectory trajectory = RandomTrajectory(rng, 5, 1);
  const Trajectory mirrored = MirroredY(trajectory);
  const Eigen::Vector4d mirror(1, -1, 1, 1);
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    const Eigen::Matrix4d expected =
        mirror.asDiagonal() * trajectory[i].world_from_camera.Matrix() * mirror.asDiagonal();
    EXPECT_LT((mirrored[i].world_from_camera.Matrix() - expected).norm(), 1e-14);
  }
}

TEST(AlignPoses, FindsTheMotionOfAPathThatPositionsDoNotTell) {
  Rng rng(6);
  const Rigid3 motion = RandomRigid(rng);
  std::vector<EvaluatedPose> poses(5);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    poses[i].reference = {RandomRigid(rng).rotation, {static_cast<double>(i), 0, 0}};
    poses[i].estimate = Inverse(motion) * poses[i].reference;
  }
  const Similarity3 found = AlignPoses(poses);
  EXPECT_EQ(found.scale, 1);
  EXPECT_LT((found.Matrix() - motion.Matrix()).norm(), 1e-12);
  // One pose is enough.
  EXPECT_LT((AlignPoses({poses.data(), 1}).Matrix() - motion.Matrix()).norm(), 1e-12);
}

// A straight path in millimetres is so long that the levers of a metre have no spread beside it.
TEST(AlignPoses, TakesAPathBesideWhichTheLeversAreShort) {
  const Rigid3 motion{ExpSo3({0.3, -0.2, 0.5}), {1, 2, 3}};
  std::vector<EvaluatedPose> poses(5);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    poses[i].reference = {ExpSo3({0, 0, 0.1}), {1e7 * static_cast<double>(i), 0, 0}};
    poses[i].estimate = Inverse(motion) * poses[i].reference;
  }
  const Similarity3 found = AlignPoses(poses);
  EXPECT_EQ(found.scale, 1);
  EXPECT_LT(AngularDistance(found.rotation, motion.rotation), 1e-5);
  for (const EvaluatedPose& pose : poses) {
    EXPECT_LT((found * pose.estimate.translation - pose.reference.translation).norm(), 1);
  }
}

TEST(TrajectoryFigure, ShowsTheTwoAxesOfMotionInRange) {
  Trajectory reference;
  for (int i = 0; i < 50; ++i) {
    const double turn = 0.1 * i;
    reference.push_back(At(0.1 * i, {3 * std::cos(turn), 0.01 * turn, 2 * std::sin(turn)}));
  }
  Rng rng(4);
  const auto error = CompareTrajectories(reference, Perturbed(reference, rng, 0.01), {});
  ASSERT_TRUE(error);
  const Figure figure = TrajectoryFigure(*error);
  for (const Figure::Polyline& line : figure.lines) {
    for (const Eigen::Vector2d& point : line.points) {
      EXPECT_TRUE(point.x() >= 0 && point.x() <= figure.width && point.y() >= 0 &&
                  point.y() <= figure.height)
          << point.transpose();
    }
  }
  const std::string svg = ToSvg(figure);
  EXPECT_THAT(svg, HasSubstr(">x [m]<"));
  EXPECT_THAT(svg, HasSubstr(">z [m]<"));
  EXPECT_THAT(svg, HasSubstr("RMSE"));
  EXPECT_EQ(svg, ToSvg(TrajectoryFigure(*error)));
}

// A path that stands still in the coordinates of a map: numbers of grid lines are beyond 2^31.
TEST(FigurePanel, HasAGridFarFromTheOrigin) {
  const Eigen::Vector2d place(448'262.1, -5'411'932.6);
  const FigurePanel panel{70, 40, 800, 400, EqualScale({place, place}, 2), "x", "y", ""};
  Figure figure;
  DrawPanel(panel, figure);
  ASSERT_GE(figure.lines.size(), 1U + 4 + 2);  // the border stands last
  EXPECT_LE(figure.lines.size(), 1U + 10 + 7);
  for (const Figure::Polyline& line : figure.lines) {
    for (const Eigen::Vector2d& p : line.points) {
      EXPECT_NEAR(p.x(), 470, 401);
      EXPECT_NEAR(p.y(), 240, 201);
    }
  }
}

TEST(TrajectoryError, AKnownAlignmentIsAppliedAsItIs) {
  Rng rng(8);
  const Trajectory reference = RandomTrajectory(rng, 20, 0.1);
  TrajectoryErrorOptions options;
  options.alignment = TrajectoryAlignment::kSim3;
  options.known_alignment = Similarity3{1, Eigen::Quaterniond::Identity(), {0.3, 0, 0.4}};
  const auto error = CompareTrajectories(reference, reference, options);
  ASSERT_TRUE(error);
  EXPECT_NEAR(error->ate.rmse, 0.5, 1e-12);
  EXPECT_EQ(error->reference_from_estimate.translation, Vector3d(0.3, 0, 0.4));
}

// One rule: what is off by 1 % at most is normalized, anything else is refused.
TEST(TrajectoryError, RotationsAreOfNormOne) {
  Rng rng(9);
  const Trajectory reference = RandomTrajectory(rng, 20, 0.1);
  const auto scaled = [&](double norm) {
    Trajectory poses = reference;
    for (StampedPose& pose : poses) pose.world_from_camera.rotation.coeffs() *= norm;
    return poses;
  };
  for (const auto& error : {CompareTrajectories(reference, scaled(0.992), {}),
                            CompareTrajectories(scaled(1.009), reference, {})}) {
    ASSERT_TRUE(error);
    EXPECT_LT(error->ate.rmse, 1e-9);
    EXPECT_LT(error->poses[3].rotation_error, 1e-7);
  }
  EXPECT_THROW(CompareTrajectories(reference, scaled(2), {}), InputError);
  EXPECT_THROW(CompareTrajectories(scaled(0.9), reference, {}), InputError);
  EXPECT_THROW(OfCamera(scaled(2), {}), InputError);
  Rigid3 mounting;
  mounting.rotation.coeffs() *= 2;
  EXPECT_THROW(OfCamera(reference, mounting), InputError);
  EXPECT_THROW(MirroredY(scaled(2)), InputError);
  EXPECT_NEAR(MirroredY(scaled(1.005))[0].world_from_camera.rotation.norm(), 1, 1e-12);
}

TEST(RollPitchYaw, AreTurnsAboutTheFixedAxesOneAfterTheOther) {
  const Vector3d angles(30, -50, 170);
  const Vector3d radians = std::numbers::pi / 180 * angles;
  const Eigen::Quaterniond rotation =
      ExpSo3({0, 0, radians.z()}) * ExpSo3({0, radians.y(), 0}) * ExpSo3({radians.x(), 0, 0});
  EXPECT_LT((RollPitchYawDeg(rotation) - angles).norm(), 1e-10);
  EXPECT_TRUE(RollPitchYawDeg(ExpSo3({0, std::numbers::pi / 2, 0})).allFinite());
}

// Yaw goes on from 180 degrees at -180: no line crosses the panel.
TEST(TrajectoryFigure, BreaksTheLineOfAnAngleThatGoesRound) {
  Trajectory reference;
  for (int i = 0; i < 60; ++i) {
    reference.push_back(At(0.1 * i, {0.2 * i, std::sin(0.1 * i), 0}, {0, 0, 0.2 * i}));
  }
  const auto error = CompareTrajectories(reference, reference, {});
  ASSERT_TRUE(error);
  for (const Figure::Polyline& line : TrajectoryFigure(*error).lines) {
    if (line.points.size() <= 5) continue;  // grid and frames
    for (std::size_t i = 1; i < line.points.size(); ++i) {
      EXPECT_LT((line.points[i] - line.points[i - 1]).norm(), 60);
    }
  }
}

TEST(TrajectoryFigure, StandsASinglePose) {
  const auto error = CompareTrajectories({At(0, {1, 2, 3})}, {At(0, {1, 2, 3})}, {});
  ASSERT_TRUE(error);
  EXPECT_THAT(ToSvg(TrajectoryFigure(*error)), testing::Not(HasSubstr("nan")));
}

}  // namespace
}  // namespace plumbline

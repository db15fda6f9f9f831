// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/geometry/unit_rotation.h"

#include "plumbline/base/error.h"
#include "plumbline/geometry/line_triangulation.h"
#include "plumbline/geometry/trajectory.h"

#include "tests/io/scratch_folder.h"
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace unit_rotation_test {

Eigen::Quaterniond Scaled(double norm) {
  Eigen::Quaterniond q = ExpSo3({0.3, -0.5, 0.2});
  q.coeffs() *= norm;
  return q;
}

TEST(UnitRotation, NormalizesWhatIsOffByLittle) {
  for (const double norm : {0.991, 1.009, 1 + 1e-6}) {
    const Eigen::Quaterniond q = UnitRotation(Scaled(norm), "q");
    EXPECT_LT((q.coeffs() - Scaled(1).coeffs()).norm(), 1e-12) << norm;
  }
  const Eigen::Quaterniond rounded = Scaled(1 + 1e-12);
  EXPECT_EQ(UnitRotation(rounded, "q").coeffs(), rounded.coeffs());
}

TEST(UnitRotation, RefusesAnyOther) {
  for (const double norm : {0.0,
                            0.98,
                            1.02,
                            2.0,
                            std::numeric_limits<double>::infinity(),
                            std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_FALSE(IsRotation(Scaled(norm))) << norm;
    EXPECT_THROW(UnitRotation(Scaled(norm), "q"), InputError) << norm;
  }
  EXPECT_EQ(MessageOf([] { UnitRotation(Scaled(2), "q"); }),
            "q: expected a quaternion of norm 1, found one of norm 2");
}

TEST(UnitRotation, NamesThePoseOfATrajectory) {
  Trajectory poses = {{0, {Scaled(1.005), {1, 2, 3}}}, {1, {Scaled(1), {}}}};
  const Trajectory unit = WithUnitRotations(poses, "estimate");
  EXPECT_NEAR(unit[0].world_from_camera.rotation.norm(), 1, 1e-15);
  EXPECT_EQ(unit[0].world_from_camera.translation, poses[0].world_from_camera.translation);
  poses[1].world_from_camera.rotation = Scaled(0.5);
  EXPECT_EQ(MessageOf([&] { WithUnitRotations(poses, "estimate"); }),
            "estimate: pose 1 (from 0): expected a quaternion of norm 1, found one of norm 0.5");
}

TEST(UnitRotation, IsTheRuleOfInterpolation) {
  const Trajectory poses = {{0, {Scaled(1.008), {0, 0, 0}}}, {100, {Scaled(1.008), {1, 0, 0}}}};
  for (const std::int64_t stamp : {0, 50, 100}) {
    const auto pose = InterpolateAt(poses, stamp, 1000);
    ASSERT_TRUE(pose);
    EXPECT_LT(AngularDistance(pose->rotation, Scaled(1)), 1e-7);
    EXPECT_NEAR(pose->rotation.norm(), 1, 1e-12);
  }
  EXPECT_THROW(InterpolateAt({{0, {Scaled(2), {}}}}, 0, 1000), InputError);
}

TEST(UnitRotation, IsTheRuleOfTriangulation) {
  const RectifiedCamera camera{500, 500, 320, 240, 0, 640, 480};
  const auto line_of = [&](double norm) {
    std::vector<LineView> views;
    for (const double x : {0.0, 0.5, 1.0}) {
      LineView view;
      view.cam_from_world.translation = {-x, -0.3 * x, 0};
      const auto pixel = [&](const Eigen::Vector3d& p) {
        return camera.Project(view.cam_from_world * p);
      };
      view.segment = {pixel({-0.5, -1, 4}), pixel({0.4, 1, 5})};
      view.cam_from_world.rotation.coeffs() *= norm;
      views.push_back(view);
    }
    return TriangulateLine(camera, views);
  };
  const auto exact = line_of(1), off = line_of(1.006);
  ASSERT_TRUE(exact);
  ASSERT_TRUE(off);
  EXPECT_LT((off->estimate.line.direction - exact->estimate.line.direction).norm(), 1e-9);
  EXPECT_THROW(line_of(1.1), InputError);
}

}  // namespace unit_rotation_test
}  // namespace plumbline

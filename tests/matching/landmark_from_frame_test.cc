// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/matching/landmark_from_frame.h"

#include "plumbline/matching/measurements.h"

#include <cmath>
#include <memory>
#include <utility>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

RectifiedCamera Stereo() {
  RectifiedCamera camera{.fx = 400, .fy = 400, .cx = 320, .cy = 240};
  camera.baseline = 0.1;
  camera.width = 640;
  camera.height = 480;
  return camera;
}

// A frame at the origin with these lines, some of them in the right image, too.
Frame FrameOf(const std::vector<Segment2>& left,
              const std::vector<std::optional<Segment2>>& right) {
  auto indexed = std::make_shared<FrameFeatures>();
  for (std::size_t i = 0; i < left.size(); ++i) {
    indexed->features.lines.push_back({left[i], 0.5});
    indexed->features.line_right.push_back(right[i] ? std::optional(MeasuredSegment{*right[i], 0.5})
                                                    : std::nullopt);
  }
  Frame frame;
  frame.lines.resize(left.size());
  frame.indexed = std::move(indexed);
  return frame;
}

// 2 m away: a disparity of 20 px, and half of it as deviation.
constexpr Disparity kScene{20, 10};
const Segment2 kAlongRows{{100, 150}, {300, 150}};

TEST(LineAtSceneDepth, PutsALineAlongTheRowsWhereTheSceneIs) {
  const RectifiedCamera camera = Stereo();
  const Frame frame = FrameOf({kAlongRows}, {Segment2{{80, 150}, {280, 150}}});
  EXPECT_FALSE(LineFromFrame(camera, frame, 0, 0.3)) << "it has no depth of its own";
  const Segment3 part = LineAtSceneDepth(camera, frame, 0, kScene).Interval();
  EXPECT_NEAR(part.start.z(), 2, 1e-9);
  EXPECT_LT((camera.Project(part.start) - kAlongRows.start).norm(), 1e-9);
  EXPECT_LT((camera.Project(part.end) - kAlongRows.end).norm(), 1e-9);
}

// Along the ray as the scene says, across it as it was measured.
TEST(LineAtSceneDepth, KnowsWhatItDoesNotKnow) {
  const RectifiedCamera camera = Stereo();
  const Frame frame = FrameOf({kAlongRows}, {std::nullopt});
  const LineModel line = LineAtSceneDepth(camera, frame, 0, kScene);
  const double middle = 0.5 * (line.start + line.end);
  const auto J = ShiftJacobian(line.line, ToOrthonormal(line.line), middle);
  const Eigen::Matrix3d covariance =
      J * RegularizedInformation(line.information).inverse() * J.transpose();
  const Eigen::Vector3d place = line.line.PointAt(middle);
  const Eigen::Vector3d ray = place.normalized();
  const Eigen::Vector3d normal = place.cross(line.line.direction).normalized();
  EXPECT_LT(std::sqrt(normal.dot(covariance * normal)), 0.5 / 400 * place.norm());
  // Two ends, each with half of the distance as deviation, and a little from the regularization.
  const double along = std::sqrt(ray.dot(covariance * ray)) / place.norm();
  EXPECT_GT(along, 0.15);
  EXPECT_LT(along, 0.5);
}

TEST(LineAtSceneDepth, AveragesWithWhatWasMeasured) {
  const RectifiedCamera camera = Stereo();
  // Upright, 5 px of disparity, known to a pixel or so: far better than the scene's 20.
  const Frame frame =
      FrameOf({Segment2{{300, 100}, {300, 300}}}, {Segment2{{295, 100}, {295, 300}}});
  const LineModel line = LineAtSceneDepth(camera, frame, 0, kScene);
  const double disparity = camera.DisparityFromDepth(line.Interval().Midpoint().z());
  EXPECT_GT(disparity, 5);
  EXPECT_LT(disparity, 5.3);
}

TEST(SceneDisparity, IsTheMedianOfWhatWasMeasured) {
  const Segment2 upright{{300, 100}, {300, 300}};
  const auto shifted = [&](double px) {
    const Eigen::Vector2d by(px, 0);
    return Segment2{upright.start - by, upright.end - by};
  };
  const Frame frame =
      FrameOf({upright, upright, upright, kAlongRows},
              {shifted(10), shifted(14), shifted(40), Segment2{{80, 150}, {280, 150}}});
  const auto scene = SceneDisparity(frame);
  ASSERT_TRUE(scene);
  EXPECT_NEAR(scene->px, 14, 1e-9);
  EXPECT_NEAR(scene->sigma_px, 7, 1e-9);
  EXPECT_FALSE(SceneDisparity(FrameOf({kAlongRows}, {std::nullopt})));
}

}  // namespace
}  // namespace plumbline

// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/solvers/absolute_pose.h"

#include <cstddef>

#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>

namespace plumbline {

std::optional<Rigid3> PoseFromPoints(const RectifiedCamera& camera,
                                     const std::vector<PointInImage>& points,
                                     double max_error_px) {
  constexpr std::size_t kMinPoints = 6;  // three fix a pose, any fourth may agree by chance
  constexpr int kRounds = 300;
  constexpr double kConfidence = 0.999;
  if (points.size() < kMinPoints) return std::nullopt;
  std::vector<cv::Point3d> world;
  std::vector<cv::Point2d> px;
  for (const PointInImage& p : points) {
    world.emplace_back(p.world.x(), p.world.y(), p.world.z());
    px.emplace_back(p.px.x(), p.px.y());
  }
  const cv::Matx33d K(camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1);
  cv::Vec3d w, t;
  std::vector<int> agree;
  try {
    if (!cv::solvePnPRansac(world,
                            px,
                            K,
                            cv::noArray(),
                            w,
                            t,
                            false,
                            kRounds,
                            static_cast<float>(max_error_px),
                            kConfidence,
                            agree,
                            cv::SOLVEPNP_AP3P)) {
      return std::nullopt;
    }
  } catch (const cv::Exception&) {  // points in no general position
    return std::nullopt;
  }
  if (agree.size() < kMinPoints) return std::nullopt;
  return Rigid3{ExpSo3({w[0], w[1], w[2]}), {t[0], t[1], t[2]}};
}

}  // namespace plumbline

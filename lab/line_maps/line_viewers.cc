// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/line_maps/line_viewers.h"

#include "plumbline/base/error.h"
#include "plumbline/geometry/segment.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <optional>

#include <Eigen/Geometry>

namespace plumbline {
namespace {

std::array<Eigen::Vector3d, 4> ImageSides(const Camera& camera) {
  const double right = camera.width() - 1, bottom = camera.height() - 1;
  // A fisheye has no ray in front of it at its border: the side is the outermost pixel with one.
  const auto ray = [&](Eigen::Vector2d px, const Eigen::Vector2d& inwards) {
    std::optional<Eigen::Vector3d> found;
    for (int i = 0; i < camera.width() + camera.height() && !found; ++i, px += inwards) {
      found = camera.Unproject(px);
    }
    PLUMBLINE_CHECK(found, "a camera with rays");
    return *found;
  };
  // Each plane goes through the middle of a border: (x - left, 0, 1) . (x, y, 1) >= 0 and so on.
  const double x0 = ray({0, bottom / 2}, {1, 0}).x(), x1 = ray({right, bottom / 2}, {-1, 0}).x();
  const double y0 = ray({right / 2, 0}, {0, 1}).y(), y1 = ray({right / 2, bottom}, {0, -1}).y();
  return {Eigen::Vector3d(1, 0, -x0), {-1, 0, x1}, {0, 1, -y0}, {0, -1, y1}};
}

bool IsVisible(const TrueLine& line, int frame) {
  if (!line.visible) return true;
  return std::any_of(line.visible->begin(), line.visible->end(), [&](const FrameRange& range) {
    return range.first <= frame && frame <= range.last;
  });
}

// Returns the part of a segment that one viewer sees. The planes are in the camera frame, the
// segment in the world.
std::optional<Stretch> SeenFrom(const LineViewer& viewer,
                                const Segment3& segment,
                                const LineViewers& viewers) {
  const Eigen::Vector3d centre = Inverse(viewer.camera_from_world).translation;
  auto seen = StretchWithin(segment, {centre, centre}, viewers.max_distance);
  if (!seen) return std::nullopt;
  const Eigen::Vector3d start = viewer.camera_from_world * segment.start;
  const Eigen::Vector3d direction = viewer.camera_from_world.rotation * segment.Direction();
  for (const Eigen::Vector3d& normal : viewers.image_sides) {
    const double at_start = normal.dot(start), slope = normal.dot(direction);
    if (slope > 0) {
      seen->from = std::max(seen->from, -at_start / slope);
    } else if (slope < 0) {
      seen->to = std::min(seen->to, -at_start / slope);
    } else if (at_start < 0) {
      return std::nullopt;
    }
  }
  if (!(seen->to > seen->from)) return std::nullopt;
  return seen;
}

}  // namespace

LineViewers ViewersOf(const Camera& camera,
                      std::span<const std::int64_t> frame_stamps,
                      std::span<const std::int64_t> keyframes,
                      std::span<const EvaluatedPose> poses) {
  std::map<std::int64_t, const EvaluatedPose*> pose_at;
  for (const EvaluatedPose& pose : poses) pose_at[pose.stamp_ns] = &pose;
  LineViewers viewers;
  viewers.image_sides = ImageSides(camera);
  for (const std::int64_t stamp : keyframes) {
    const auto frame = std::lower_bound(frame_stamps.begin(), frame_stamps.end(), stamp);
    const auto pose = pose_at.find(stamp);
    if (frame == frame_stamps.end() || *frame != stamp || pose == pose_at.end()) continue;
    viewers.frames.push_back(
        {static_cast<int>(frame - frame_stamps.begin()), Inverse(pose->second->reference)});
  }
  return viewers;
}

std::vector<Stretch> SeenStretches(const TrueLine& line, const LineViewers& viewers) {
  std::vector<Stretch> seen;
  if (!(line.segment.Length() > 0)) return seen;
  for (const LineViewer& viewer : viewers.frames) {
    if (!IsVisible(line, viewer.frame)) continue;
    if (const auto stretch = SeenFrom(viewer, line.segment, viewers)) seen.push_back(*stretch);
  }
  return CoveredAtLeast(seen, viewers.min_frames);
}

}  // namespace plumbline

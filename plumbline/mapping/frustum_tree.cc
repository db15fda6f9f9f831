// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/mapping/frustum_tree.h"

#include "plumbline/base/elementary.h"
#include "plumbline/base/error.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include <Eigen/Geometry>

namespace plumbline {
namespace {

constexpr int kLeaf = 4;
// Margin against rounding, so that nothing is missed that an exact test would find.
constexpr double kConeMargin = 1e-6;

double AngleBetween(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return math::Atan2(a.cross(b).norm(), a.dot(b));
}

}  // namespace

FrustumTree::FrustumTree(const Map& map, const RectifiedCamera& camera) {
  // The image with a margin of one pixel on all sides.
  for (const double u : {-1.0, static_cast<double>(camera.width)}) {
    for (const double v : {-1.0, static_cast<double>(camera.height)}) {
      half_view_ =
          std::max(half_view_, AngleBetween(Eigen::Vector3d::UnitZ(), camera.Unproject({u, v})));
    }
  }
  half_view_ += kConeMargin;
  // A step across the ray at distance d moves the pixel by f / (d cos^2), where cos is that of the
  // ray's angle from the axis.
  const double cosine = math::Cos(half_view_);
  px_per_radian_ = (1 + kConeMargin) * std::max(camera.fx, camera.fy) / (cosine * cosine);
  for (const auto& [id, keyframe] : map.keyframes()) {
    const Rigid3 world_from_cam = Inverse(keyframe.frame.cam_from_world);
    Node camera_alone{.centre = world_from_cam.translation,
                      .axis = world_from_cam.rotation * Eigen::Vector3d::UnitZ()};
    Open(half_view_, camera_alone);
    cameras_.push_back(camera_alone);
    order_.push_back(static_cast<int>(keyframes_.size()));
    keyframes_.push_back(&keyframe);
  }
  if (!cameras_.empty()) Build(0, static_cast<int>(cameras_.size()));
}

int FrustumTree::IndexOf(KeyFrameId id) const {
  const auto place = std::lower_bound(
      keyframes_.begin(), keyframes_.end(), id, [](const KeyFrame* keyframe, KeyFrameId value) {
        return keyframe->id < value;
      });
  PLUMBLINE_CHECK(place != keyframes_.end() && (*place)->id == id, "a keyframe of another map");
  return static_cast<int>(place - keyframes_.begin());
}

void FrustumTree::Build(int begin, int end) {
  const std::size_t index = nodes_.size();
  nodes_.push_back({.begin = begin, .end = end});
  Enclose(nodes_[index]);
  if (end - begin <= kLeaf) return;
  Eigen::AlignedBox3d box;
  for (int i = begin; i < end; ++i) {
    box.extend(cameras_[static_cast<std::size_t>(order_[static_cast<std::size_t>(i)])].centre);
  }
  Eigen::Index side = 0;
  box.sizes().maxCoeff(&side);
  const int middle = begin + (end - begin) / 2;
  const auto place = [&](int i) { return order_.begin() + i; };
  std::nth_element(place(begin), place(middle), place(end), [&](int a, int b) {
    const double x = cameras_[static_cast<std::size_t>(a)].centre(side);
    const double y = cameras_[static_cast<std::size_t>(b)].centre(side);
    return x != y ? x < y : a < b;
  });
  Build(begin, middle);
  nodes_[index].second = static_cast<int>(nodes_.size());
  Build(middle, end);
}

void FrustumTree::Enclose(Node& node) const {
  Eigen::AlignedBox3d box;
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();
  const auto camera = [&](int i) -> const Node& {
    return cameras_[static_cast<std::size_t>(order_[static_cast<std::size_t>(i)])];
  };
  for (int i = node.begin; i < node.end; ++i) {
    box.extend(camera(i).centre);
    axis += camera(i).axis;
  }
  node.centre = box.center();
  const bool any_way = !(axis.norm() > 1e-3);
  node.axis = any_way ? Eigen::Vector3d::UnitZ().eval() : axis.normalized();
  double spread = any_way ? std::numbers::pi : 0;
  for (int i = node.begin; i < node.end; ++i) {
    node.radius = std::max(node.radius, (camera(i).centre - node.centre).norm());
    spread = std::max(spread, AngleBetween(node.axis, camera(i).axis));
  }
  Open(spread + half_view_, node);
}

void FrustumTree::Open(double angle, Node& node) {
  node.open = angle;
  node.cos_open = math::Cos(angle);
  node.sin_open = math::Sin(angle);
}

bool FrustumTree::MaySee(const Node& node,
                         const Eigen::Vector3d& target,
                         double radius,
                         double reach) const {
  const Eigen::Vector3d to_target = target - node.centre;
  const double distance = to_target.norm();
  if (distance > (reach + node.radius) * (1 + kConeMargin)) return false;
  const double both = radius + node.radius;
  if (!(distance > both)) return true;
  if (node.open >= std::numbers::pi) return true;
  // The cone widens by the angle `by` under which both balls together are seen.
  const double sin_by = both / distance;
  const double cos_by = std::sqrt((1 - sin_by) * (1 + sin_by));
  // The cone is then so wide that it covers all directions.
  if (node.sin_open * cos_by + node.cos_open * sin_by <= 0) return true;
  const double cos_widened = node.cos_open * cos_by - node.sin_open * sin_by;
  return !(node.axis.dot(to_target) < distance * (cos_widened - kConeMargin));
}

std::vector<int> FrustumTree::MayShow(const Segment3& segment,
                                      double min_length_px,
                                      double max_distance) const {
  std::vector<int> found;
  if (nodes_.empty()) return found;
  const Eigen::Vector3d middle = segment.Midpoint();
  const double length = segment.Length();
  const double radius = 0.5 * length * (1 + kConeMargin);
  // The whole segment is at least `distance - radius` away, which limits the angle under which it
  // is seen.
  double reach = max_distance;
  if (min_length_px > 0) {
    reach = std::min(reach, radius + length * px_per_radian_ / min_length_px);
  }
  std::vector<int> open{0};
  while (!open.empty()) {
    const int index = open.back();
    open.pop_back();
    const Node& node = nodes_[static_cast<std::size_t>(index)];
    if (!MaySee(node, middle, radius, reach)) continue;
    if (node.second >= 0) {
      open.push_back(node.second);
      open.push_back(index + 1);
      continue;
    }
    for (int i = node.begin; i < node.end; ++i) {
      const int camera = order_[static_cast<std::size_t>(i)];
      if (MaySee(cameras_[static_cast<std::size_t>(camera)], middle, radius, reach)) {
        found.push_back(camera);
      }
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace plumbline

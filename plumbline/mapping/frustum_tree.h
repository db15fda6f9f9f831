// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/rectified_camera.h"
#include "plumbline/geometry/segment.h"
#include "plumbline/map/map.h"

#include <cstddef>
#include <limits>
#include <vector>

#include <Eigen/Core>

namespace plumbline {

// Finds the keyframes of a map that may have a given segment in their image, without visiting all
// of them: a tree whose nodes bound the positions and viewing directions of their cameras.
class FrustumTree {
 public:
  // The map must outlive the tree, and its keyframes must not move. O(n log n).
  FrustumTree(const Map& map, const RectifiedCamera& camera);

  std::size_t size() const { return keyframes_.size(); }
  // Returns the index of a keyframe; indices are ordered by id.
  int IndexOf(KeyFrameId id) const;
  const KeyFrame& keyframe(int index) const { return *keyframes_[static_cast<std::size_t>(index)]; }

  // Returns the indices, ascending, of all keyframes that show a segment of the world, and of some
  // that do not: those whose field of view, approximated by a cone, meets the ball around the
  // segment, and which are near enough for a segment across the line of sight to be long enough.
  // O(log n + found) for evenly spread cameras.
  //   min_length_px  the segment's image must be longer than this
  //   max_distance   largest distance of its midpoint from the camera
  std::vector<int> MayShow(const Segment3& segment,
                           double min_length_px = 0,
                           double max_distance = std::numeric_limits<double>::infinity()) const;

 private:
  // The cameras `begin` to `end` of order_. The children of a node are the next node, and `second`.
  struct Node {
    int begin = 0, end = 0;
    int second = -1;  // -1 for a leaf
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    double radius = 0;  // radius of a ball around the cameras' centres
    Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();
    double open = 0;  // largest angle between `axis` and a ray of a camera's image
    double cos_open = 1, sin_open = 0;
  };

  void Build(int begin, int end);
  void Enclose(Node& node) const;
  static void Open(double angle, Node& node);
  // Returns true if a camera of the node may see a part of the ball around the target, within
  // `reach`.
  bool MaySee(const Node& node, const Eigen::Vector3d& target, double radius, double reach) const;

  std::vector<const KeyFrame*> keyframes_;
  std::vector<Node> cameras_;  // one node for each camera, by index
  std::vector<int> order_;
  std::vector<Node> nodes_;
  double half_view_ = 0;      // largest angle between the axis and a ray of the image
  double px_per_radian_ = 0;  // upper bound anywhere in the image
};

}  // namespace plumbline

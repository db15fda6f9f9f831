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

// Finds the keyframes of a map that may have a given segment in their image, without going through
// all of them. It is a tree in which each node knows where its cameras stand and which way they
// look.
class FrustumTree {
 public:
  // The segment that is looked for, and how large and near it must be seen.
  struct Wanted {
    Segment3 segment;          // in the world
    double min_length_px = 0;  // its image must be longer than this
    // Largest distance of its middle from the camera.
    double max_distance = std::numeric_limits<double>::infinity();
  };

  // The map must outlive the tree, and its keyframes stay as they are. O(n log n).
  FrustumTree(const Map& map, const RectifiedCamera& camera);

  std::size_t size() const { return keyframes_.size(); }
  // Returns the index of a keyframe; indices are ordered by id.
  int IndexOf(KeyFrameId id) const;
  const KeyFrame& keyframe(int index) const { return *keyframes_[static_cast<std::size_t>(index)]; }

  // Returns the indices, ascending, of all keyframes that show the segment as wanted, and of some
  // that do not. These are the keyframes whose field of view, taken as a cone, meets the ball
  // around the segment, and which are so near that a segment across the line of sight would be long
  // enough. O(log n + found) for cameras that are spread evenly.
  std::vector<int> MayShow(const Wanted& wanted) const;

 private:
  // The cameras `begin` to `end` of order_. The children of a node are the one after it, and
  // `second`.
  struct Node {
    int begin = 0, end = 0;
    int second = -1;  // -1 for a leaf
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    double radius = 0;  // radius of a ball around the cameras' centres
    Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();
    double open = 0;  // largest angle of a ray of a camera's image with `axis`
    double cos_open = 1, sin_open = 0;
  };

  void Build(int begin, int end);
  void Enclose(Node& node) const;
  static void Open(double angle, Node& node);
  // Whether a camera of the node may see something of the ball around the target, within `reach`.
  bool MaySee(const Node& node, const Eigen::Vector3d& target, double radius, double reach) const;

  std::vector<const KeyFrame*> keyframes_;
  std::vector<Node> cameras_;  // one node for each camera, by index
  std::vector<int> order_;
  std::vector<Node> nodes_;
  double half_view_ = 0;      // largest angle of a ray of the image with the axis
  double px_per_radian_ = 0;  // upper bound anywhere in the image
};

}  // namespace plumbline

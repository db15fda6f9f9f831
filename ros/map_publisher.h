// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "live_slam.h"
#include "node_parameters.h"

#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/time.h>

namespace plumbline::ros_node {

// Publishes a map, latched: ~points (PointCloud2), ~lines (a marker of segments) and ~path (the
// base at the keyframes, as corrected by now), all in the map's frame.
class MapPublisher {
 public:
  MapPublisher(ros::NodeHandle& own, const NodeParameters& parameters);

  // Whether somebody listens.
  bool IsWanted() const;
  // In any thread.
  void Publish(const MapView& map, const Rigid3& base_from_camera, const ros::Time& stamp) const;

 private:
  const NodeParameters& parameters_;
  ros::Publisher points_, lines_, path_;
};

}  // namespace plumbline::ros_node

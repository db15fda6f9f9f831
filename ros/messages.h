// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/se3.h"
#include "plumbline/io/recordings/transform_message.h"

#include "live_slam.h"
#include "odometry_frame.h"
#include "transport.h"
#include <cstdint>
#include <string>
#include <vector>

namespace plumbline::ros_node {

// The time and the frame of a message.
struct MessageHeader {
  std::int64_t stamp_ns = 0;
  std::string frame;
};

// The messages that the node publishes, in the form of ROS 2 (`cdr`) or ROS 1.

Bytes TextMessage(bool cdr, const std::string& text);                          // std_msgs/String
Bytes PoseMessage(bool cdr, const MessageHeader& header, const Rigid3& pose);  // PoseStamped
Bytes TransformsMessage(bool cdr, const std::vector<TransformMessage>& transforms);  // TFMessage
// nav_msgs/Odometry. The covariance of the speed is zero.
Bytes OdometryMessage(bool cdr,
                      const MessageHeader& header,
                      const std::string& base_frame,
                      const BasePose& pose,
                      const Matrix6d& covariance);

// The map in the frame of the header, which is the base at its first keyframe: its points
// (sensor_msgs/PointCloud2), its lines (visualization_msgs/Marker, in ROS 2 a MarkerArray of one)
// and the base at its keyframes (nav_msgs/Path).
Bytes PointsMessage(bool cdr,
                    const MessageHeader& header,
                    const MapView& map,
                    const Rigid3& base_from_camera);
Bytes LinesMessage(bool cdr,
                   const MessageHeader& header,
                   const MapView& map,
                   const Rigid3& base_from_camera);
Bytes PathMessage(bool cdr,
                  const MessageHeader& header,
                  const MapView& map,
                  const Rigid3& base_from_camera);

}  // namespace plumbline::ros_node

// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "map_publisher.h"

namespace plumbline::ros_node {

MapPublisher::MapPublisher(Transport& transport) : cdr_(transport.UsesCdr()) {
  const char* lines = cdr_ ? "visualization_msgs/MarkerArray" : "visualization_msgs/Marker";
  points_ =
      transport.Advertise({transport.Resolve("~/points"), "sensor_msgs/PointCloud2", 1, true});
  lines_ = transport.Advertise({transport.Resolve("~/lines"), lines, 1, true});
  path_ = transport.Advertise({transport.Resolve("~/path"), "nav_msgs/Path", 1, true});
}

bool MapPublisher::IsWanted() const {
  return points_->HasSubscribers() || lines_->HasSubscribers() || path_->HasSubscribers();
}

void MapPublisher::Publish(const MapView& map,
                           const Rigid3& base_from_camera,
                           const MessageHeader& header) const {
  const auto publish = [&](Publication& publication, auto message_of) {
    if (publication.HasSubscribers()) {
      publication.Publish(message_of(cdr_, header, map, base_from_camera));
    }
  };
  publish(*points_, PointsMessage);
  publish(*lines_, LinesMessage);
  publish(*path_, PathMessage);
}

}  // namespace plumbline::ros_node

// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "map_publisher.h"

#include "frames.h"
#include <cstdint>

#include <nav_msgs/Path.h>
#include <sensor_msgs/PointCloud2.h>
#include <sensor_msgs/point_cloud2_iterator.h>
#include <visualization_msgs/Marker.h>

namespace plumbline::ros_node {
namespace {

sensor_msgs::PointCloud2 PointsOf(const MapView& map, const Rigid3& map_from_world) {
  sensor_msgs::PointCloud2 cloud;
  sensor_msgs::PointCloud2Modifier modifier(cloud);
  modifier.setPointCloud2FieldsByString(1, "xyz");
  modifier.resize(map.points.size());
  sensor_msgs::PointCloud2Iterator<float> out(cloud, "x");
  for (const Eigen::Vector3d& point : map.points) {
    const Eigen::Vector3f place = (map_from_world * point).cast<float>();
    for (int i = 0; i < 3; ++i) out[i] = place[i];
    ++out;
  }
  return cloud;
}

visualization_msgs::Marker LinesOf(const MapView& map, const Rigid3& map_from_world) {
  visualization_msgs::Marker marker;
  marker.ns = "plumbline";
  marker.type = visualization_msgs::Marker::LINE_LIST;
  marker.action = visualization_msgs::Marker::ADD;
  marker.pose.orientation.w = 1;
  marker.scale.x = 0.01;  // m, width
  marker.color.r = 1;
  marker.color.g = 0.5;
  marker.color.a = 1;
  for (const auto& [start, end] : map.lines) {
    marker.points.push_back(ToPoint(map_from_world * start));
    marker.points.push_back(ToPoint(map_from_world * end));
  }
  return marker;
}

nav_msgs::Path PathOf(const MapView& map, const Rigid3& base_from_camera) {
  nav_msgs::Path path;
  for (const auto& [stamp_ns, world_from_camera] : map.keyframes) {
    geometry_msgs::PoseStamped pose;
    if (stamp_ns >= 0) pose.header.stamp.fromNSec(static_cast<std::uint64_t>(stamp_ns));
    pose.pose = ToPose(base_from_camera * world_from_camera * Inverse(base_from_camera));
    path.poses.push_back(pose);
  }
  return path;
}

}  // namespace

MapPublisher::MapPublisher(ros::NodeHandle& own, const NodeParameters& parameters)
    : parameters_(parameters) {
  points_ = own.advertise<sensor_msgs::PointCloud2>("points", 1, true);
  lines_ = own.advertise<visualization_msgs::Marker>("lines", 1, true);
  path_ = own.advertise<nav_msgs::Path>("path", 1, true);
}

bool MapPublisher::IsWanted() const {
  return points_.getNumSubscribers() + lines_.getNumSubscribers() + path_.getNumSubscribers() > 0;
}

void MapPublisher::Publish(const MapView& map,
                           const Rigid3& base_from_camera,
                           const ros::Time& stamp) const {
  std_msgs::Header header;
  header.stamp = stamp;
  header.frame_id = parameters_.map_frame;
  if (points_.getNumSubscribers() > 0) {
    sensor_msgs::PointCloud2 points = PointsOf(map, base_from_camera);
    points.header = header;
    points_.publish(points);
  }
  if (lines_.getNumSubscribers() > 0) {
    visualization_msgs::Marker lines = LinesOf(map, base_from_camera);
    lines.header = header;
    lines_.publish(lines);
  }
  if (path_.getNumSubscribers() > 0) {
    nav_msgs::Path path = PathOf(map, base_from_camera);
    path.header = header;
    for (geometry_msgs::PoseStamped& pose : path.poses)
      pose.header.frame_id = parameters_.map_frame;
    path_.publish(path);
  }
}

}  // namespace plumbline::ros_node

// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "pose_publisher.h"

#include "frames.h"
#include <algorithm>
#include <utility>
#include <vector>

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/TransformStamped.h>
#include <nav_msgs/Odometry.h>
#include <ros/console.h>
#include <std_msgs/String.h>

namespace plumbline::ros_node {
namespace {

geometry_msgs::TransformStamped Stamped(const ros::Time& stamp,
                                        const std::string& parent,
                                        const std::string& child,
                                        const Rigid3& parent_from_child) {
  geometry_msgs::TransformStamped message;
  message.header.stamp = stamp;
  message.header.frame_id = parent;
  message.child_frame_id = child;
  message.transform = ToTransform(parent_from_child);
  return message;
}

nav_msgs::Odometry OdometryOf(const BasePose& pose,
                              const NodeParameters& parameters,
                              const ros::Time& stamp) {
  nav_msgs::Odometry message;
  message.header.stamp = stamp;
  message.header.frame_id = parameters.odom_frame;
  message.child_frame_id = parameters.base_frame;
  message.pose.pose = ToPose(pose.odom_from_base);
  message.twist.twist.linear.x = pose.linear.x();
  message.twist.twist.linear.y = pose.linear.y();
  message.twist.twist.linear.z = pose.linear.z();
  message.twist.twist.angular.x = pose.angular.x();
  message.twist.twist.angular.y = pose.angular.y();
  message.twist.twist.angular.z = pose.angular.z();
  return message;
}

}  // namespace

PosePublisher::PosePublisher(ros::NodeHandle& own, const NodeParameters& parameters)
    : parameters_(parameters), listener_(buffer_) {
  pose_ = own.advertise<geometry_msgs::PoseStamped>("pose", 10);
  odometry_publisher_ = own.advertise<nav_msgs::Odometry>("odometry", 10);
  state_ = own.advertise<std_msgs::String>("state", 1, true);
}

std::optional<Rigid3> PosePublisher::FindMounting(const std::string& camera_frame) {
  constexpr double kPatience = 2;  // seconds of the wall clock
  if (camera_frame == parameters_.base_frame) return Rigid3();
  try {
    return FromTransform(
        buffer_.lookupTransform(parameters_.base_frame, camera_frame, ros::Time(0)).transform);
  } catch (const tf2::TransformException& error) {
    const ros::WallTime now = ros::WallTime::now();
    if (!waiting_since_) waiting_since_ = now;
    if ((now - *waiting_since_).toSec() < kPatience) return std::nullopt;
    ROS_WARN(
        "tf knows no transform from %s to %s (%s): the base is taken to be in the camera and to "
        "look where it looks",
        parameters_.base_frame.c_str(),
        camera_frame.c_str(),
        error.what());
    return ForwardLooking();
  }
}

void PosePublisher::Publish(const FrameOutcome& frame,
                            const Rigid3& base_from_camera,
                            const ros::Time& stamp) {
  PublishState(frame);
  if (!frame.world_from_camera) return;
  const Rigid3 map_from_base =
      base_from_camera * *frame.world_from_camera * Inverse(base_from_camera);
  if (!odometry_) odometry_.emplace();
  const BasePose& pose = odometry_->Next(frame.stamp_ns, frame.map, map_from_base, frame.corrected);
  geometry_msgs::PoseStamped message;
  message.header.stamp = stamp;
  message.header.frame_id = parameters_.map_frame;
  message.pose = ToPose(pose.map_from_base);
  pose_.publish(message);
  nav_msgs::Odometry odometry = OdometryOf(pose, parameters_, stamp);
  if (frame.covariance) {
    const Matrix6d covariance =
        BaseCovariance(pose, base_from_camera, *frame.world_from_camera, *frame.covariance);
    std::copy_n(covariance.data(), covariance.size(), odometry.pose.covariance.begin());
  }
  odometry_publisher_.publish(odometry);
  if (parameters_.publish_tf) PublishTransforms(pose, stamp);
}

void PosePublisher::PublishState(const FrameOutcome& frame) {
  if (frame.skipped || std::exchange(state_now_, frame.state) == frame.state) return;
  std_msgs::String message;
  message.data = frame.state;
  state_.publish(message);
}

void PosePublisher::PublishTransforms(const BasePose& pose, const ros::Time& stamp) {
  std::vector<geometry_msgs::TransformStamped> transforms;
  Rigid3 map_from_odom = pose.MapFromOdom();
  if (parameters_.publish_odom_tf) {
    transforms.push_back(
        Stamped(stamp, parameters_.odom_frame, parameters_.base_frame, pose.odom_from_base));
  } else {
    const auto odom_from_base = OdomFromOthers(stamp);
    if (!odom_from_base) return;
    map_from_odom = pose.map_from_base * Inverse(*odom_from_base);
  }
  transforms.push_back(
      Stamped(stamp, parameters_.map_frame, parameters_.odom_frame, map_from_odom));
  broadcaster_.sendTransform(transforms);
}

std::optional<Rigid3> PosePublisher::OdomFromOthers(const ros::Time& stamp) const {
  try {
    return FromTransform(
        buffer_.lookupTransform(parameters_.odom_frame, parameters_.base_frame, stamp).transform);
  } catch (const tf2::TransformException& error) {
    ROS_WARN_THROTTLE(5,
                      "no transform from %s to %s: nothing tells where %s is in the map (%s)",
                      parameters_.odom_frame.c_str(),
                      parameters_.base_frame.c_str(),
                      parameters_.odom_frame.c_str(),
                      error.what());
    return std::nullopt;
  }
}

}  // namespace plumbline::ros_node

// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "pose_publisher.h"

#include "plumbline/base/printable.h"

#include "messages.h"
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace plumbline::ros_node {
namespace {

// The camera in a base that looks where it looks: x ahead, y to the left, z up (REP 103) for z
// ahead, x to the right, y down.
Rigid3 ForwardLooking() {
  Eigen::Matrix3d base_from_camera;
  base_from_camera << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return {Eigen::Quaterniond(base_from_camera), Eigen::Vector3d::Zero()};
}

}  // namespace

PosePublisher::PosePublisher(Transport& transport, NodeLog& log, const NodeParameters& parameters)
    : transport_(transport), log_(log), parameters_(parameters) {
  pose_ = transport.Advertise({transport.Resolve("~/pose"), "geometry_msgs/PoseStamped", 10});
  odometry_publication_ =
      transport.Advertise({transport.Resolve("~/odometry"), "nav_msgs/Odometry", 10});
  state_ = transport.Advertise({transport.Resolve("~/state"), "std_msgs/String", 1, true});
  if (parameters.publish_tf) {
    const std::string type = "tf2_msgs/TFMessage";
    tf_ = transport.Advertise({transport.Resolve("/tf"), type, 100});
    tf_static_ = transport.Advertise({transport.Resolve("/tf_static"), type, 1, true});
  }
  ListenTo("/tf", false);
  ListenTo("/tf_static", true);
}

void PosePublisher::ListenTo(const std::string& topic, bool is_static) {
  const TopicSettings settings{transport_.Resolve(topic), "tf2_msgs/TFMessage", 100, is_static};
  transport_.Subscribe(settings, [this, settings, is_static](const Bytes& bytes) {
    const auto transforms = ParseRosTransforms(transport_.UsesCdr(), bytes);
    if (transforms) return transforms_.Add(*transforms, is_static);
    log_.Refuse(settings, bytes.size());
  });
}

std::optional<Rigid3> PosePublisher::FindMounting(const std::string& camera_frame) {
  constexpr std::chrono::seconds kPatience{2};
  if (camera_frame == parameters_.base_frame) return Rigid3();
  const auto found = transforms_.Find(parameters_.base_frame, camera_frame);
  if (found) return *found;
  const auto now = std::chrono::steady_clock::now();
  if (!waiting_since_) waiting_since_ = now;
  if (now - *waiting_since_ < kPatience) return std::nullopt;
  log_.Say(Severity::kWarning,
           fmt::format("tf knows no transform from {} to {} ({}): the base is taken to be in the "
                       "camera and to look where it looks",
                       parameters_.base_frame,
                       Printable(camera_frame),
                       Printable(found.error())));
  if (tf_static_) {
    const TransformMessage mounting{0, parameters_.base_frame, camera_frame, ForwardLooking()};
    tf_static_->Publish(TransformsMessage(transport_.UsesCdr(), {mounting}));
  }
  return ForwardLooking();
}

void PosePublisher::Publish(const FrameOutcome& frame, const Rigid3& base_from_camera) {
  PublishState(frame);
  if (frame.skipped) {
    log_.Throttled(Severity::kWarning,
                   fmt::format("frames are left out for want of time: {} so far", ++skipped_));
  }
  if (!frame.world_from_camera) return;
  ++published_;
  const Rigid3 map_from_base =
      base_from_camera * *frame.world_from_camera * Inverse(base_from_camera);
  if (!odometry_) odometry_.emplace();
  const BasePose& pose = odometry_->Next(frame.stamp_ns, frame.map, map_from_base, frame.corrected);
  const bool cdr = transport_.UsesCdr();
  pose_->Publish(PoseMessage(cdr, {frame.stamp_ns, parameters_.map_frame}, pose.map_from_base));
  std::optional<Matrix6d> covariance;
  if (frame.covariance) {
    covariance =
        BaseCovariance(pose, base_from_camera, *frame.world_from_camera, *frame.covariance);
  }
  odometry_publication_->Publish(OdometryMessage(cdr,
                                                 {frame.stamp_ns, parameters_.odom_frame},
                                                 parameters_.base_frame,
                                                 pose,
                                                 covariance.value_or(Matrix6d::Zero())));
  if (parameters_.publish_tf) PublishTransforms(pose, frame.stamp_ns);
}

void PosePublisher::PublishState(const FrameOutcome& frame) {
  if (frame.skipped || std::exchange(state_now_, frame.state) == frame.state) return;
  state_->Publish(TextMessage(transport_.UsesCdr(), frame.state));
}

void PosePublisher::PublishTransforms(const BasePose& pose, std::int64_t stamp_ns) {
  const auto& [map, odom, base] =
      std::tie(parameters_.map_frame, parameters_.odom_frame, parameters_.base_frame);
  std::vector<TransformMessage> transforms;
  Rigid3 map_from_odom = pose.MapFromOdom();
  if (parameters_.publish_odom_tf) {
    transforms.push_back({stamp_ns, odom, base, pose.odom_from_base});
  } else {
    const auto odom_from_base = transforms_.Find(odom, base, stamp_ns);
    if (!odom_from_base) {
      log_.Throttled(
          Severity::kWarning,
          fmt::format("no transform from {0} to {1}: nothing tells where {0} is in the map ({2})",
                      odom,
                      base,
                      Printable(odom_from_base.error())));
      return;
    }
    map_from_odom = pose.map_from_base * Inverse(*odom_from_base);
  }
  transforms.push_back({stamp_ns, map, odom, map_from_odom});
  tf_->Publish(TransformsMessage(transport_.UsesCdr(), transforms));
}

}  // namespace plumbline::ros_node

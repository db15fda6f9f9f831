// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "messages.h"

#include "message_writer.h"

namespace plumbline::ros_node {
namespace {

constexpr std::uint32_t kFloat32 = 7;   // sensor_msgs/PointField
constexpr std::uint32_t kLineList = 5;  // visualization_msgs/Marker, type
constexpr double kLineWidth = 0.01;     // m
constexpr std::uint32_t kPointSize = 3 * sizeof(float);

MessageWriter Begin(bool cdr, const MessageHeader& header) {
  MessageWriter writer(cdr);
  writer.Header(header.stamp_ns, header.frame);
  return writer;
}

}  // namespace

Bytes TextMessage(bool cdr, const std::string& text) {
  MessageWriter writer(cdr);
  writer.Text(text);
  return writer.bytes();
}

Bytes PoseMessage(bool cdr, const MessageHeader& header, const Rigid3& pose) {
  MessageWriter writer = Begin(cdr, header);
  writer.Motion(pose);
  return writer.bytes();
}

Bytes TransformsMessage(bool cdr, const std::vector<TransformMessage>& transforms) {
  MessageWriter writer(cdr);
  writer.U32(static_cast<std::uint32_t>(transforms.size()));
  for (const TransformMessage& transform : transforms) {
    writer.Header(transform.stamp_ns, transform.parent);
    writer.Text(transform.child);
    writer.Motion(transform.parent_from_child);
  }
  return writer.bytes();
}

Bytes OdometryMessage(bool cdr,
                      const MessageHeader& header,
                      const std::string& base_frame,
                      const BasePose& pose,
                      const Matrix6d& covariance) {
  MessageWriter writer = Begin(cdr, header);
  writer.Text(base_frame);
  writer.Motion(pose.odom_from_base);
  writer.Matrix(covariance);
  writer.Vector(pose.linear);
  writer.Vector(pose.angular);
  writer.Matrix(Matrix6d::Zero());
  return writer.bytes();
}

Bytes PointsMessage(bool cdr,
                    const MessageHeader& header,
                    const MapView& map,
                    const Rigid3& base_from_camera) {
  MessageWriter writer = Begin(cdr, header);
  const auto count = static_cast<std::uint32_t>(map.points.size());
  writer.U32(1);  // row
  writer.U32(count);
  writer.U32(3);  // fields
  std::uint32_t offset = 0;
  for (const char* name : {"x", "y", "z"}) {
    writer.Text(name);
    writer.U32(offset);
    writer.U8(kFloat32);
    writer.U32(1);
    offset += sizeof(float);
  }
  writer.U8(0);  // little-endian
  writer.U32(kPointSize);
  writer.U32(kPointSize * count);
  writer.U32(kPointSize * count);
  // Bytes without gaps: behind a number of 32 bits those of further ones need none.
  for (const Eigen::Vector3d& point : map.points) {
    const Eigen::Vector3f place = (base_from_camera * point).cast<float>();
    for (int i = 0; i < 3; ++i) writer.F32(place[i]);
  }
  writer.U8(1);  // all points are valid
  return writer.bytes();
}

Bytes LinesMessage(bool cdr,
                   const MessageHeader& header,
                   const MapView& map,
                   const Rigid3& base_from_camera) {
  MessageWriter writer(cdr);
  if (cdr) writer.U32(1);  // markers
  writer.Header(header.stamp_ns, header.frame);
  writer.Text("plumbline");
  writer.U32(0);  // id
  writer.U32(kLineList);
  writer.U32(0);  // add
  writer.Motion(Rigid3());
  writer.Vector({kLineWidth, 0, 0});
  writer.Color(1, 0.5F, 0);
  for (int i = 0; i < 2; ++i) writer.U32(0);  // for ever: seconds, nanoseconds
  writer.U8(0);
  writer.U32(static_cast<std::uint32_t>(2 * map.lines.size()));
  for (const auto& [start, end] : map.lines) {
    writer.Vector(base_from_camera * start);
    writer.Vector(base_from_camera * end);
  }
  writer.U32(0);  // colours
  if (cdr) {
    writer.Text("");       // texture_resource
    writer.Header(0, "");  // texture
    writer.Text("");       // its format
    writer.U32(0);         // its bytes
    writer.U32(0);         // uv_coordinates
  }
  writer.Text("");  // text
  writer.Text("");  // mesh_resource
  if (cdr) {
    writer.Text("");  // mesh_file: name
    writer.U32(0);    // and bytes
  }
  writer.U8(0);
  return writer.bytes();
}

Bytes PathMessage(bool cdr,
                  const MessageHeader& header,
                  const MapView& map,
                  const Rigid3& base_from_camera) {
  MessageWriter writer = Begin(cdr, header);
  writer.U32(static_cast<std::uint32_t>(map.keyframes.size()));
  for (const auto& [stamp_ns, world_from_camera] : map.keyframes) {
    writer.Header(stamp_ns, header.frame);
    writer.Motion(base_from_camera * world_from_camera * Inverse(base_from_camera));
  }
  return writer.bytes();
}

}  // namespace plumbline::ros_node

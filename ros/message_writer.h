// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/se3.h"

#include "transport.h"
#include <cstdint>
#include <string_view>

namespace plumbline::ros_node {

// Writes the fields of a message one after the other, as ROS 1 has them (without gaps,
// wiki.ros.org/msg) or ROS 2 (little-endian CDR, OMG DDS-XTypes 1.3, 7.4.3: numbers at multiples
// of their size, texts with a zero at their end, behind four bytes that name the encoding).
class MessageWriter {
 public:
  explicit MessageWriter(bool cdr);

  bool cdr() const { return cdr_; }
  void U8(std::uint8_t value) { bytes_.push_back(value); }
  void U32(std::uint32_t value) { Number(value, 4); }
  void F32(float value);
  void F64(double value);
  void Text(std::string_view text);

  void Header(std::int64_t stamp_ns, std::string_view frame);  // std_msgs/Header
  void Vector(const Eigen::Vector3d& vector);                  // geometry_msgs/Point and Vector3
  void Motion(const Rigid3& motion);                           // geometry_msgs/Pose and Transform
  void Matrix(const Matrix6d& matrix);                         // row by row; covariances
  void Color(float red, float green, float blue);              // std_msgs/ColorRGBA, opaque

  const Bytes& bytes() const { return bytes_; }

 private:
  void Number(std::uint64_t value, std::size_t size);

  bool cdr_;
  Bytes bytes_;
};

}  // namespace plumbline::ros_node

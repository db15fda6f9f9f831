// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "message_writer.h"

#include "plumbline/base/units.h"

#include <bit>

namespace plumbline::ros_node {
namespace {

constexpr std::size_t kCdrHeader = 4;

}  // namespace

MessageWriter::MessageWriter(bool cdr) : cdr_(cdr) {
  if (cdr) bytes_ = {0, 1, 0, 0};
}

void MessageWriter::Number(std::uint64_t value, std::size_t size) {
  while (cdr_ && (bytes_.size() - kCdrHeader) % size != 0) bytes_.push_back(0);
  for (std::size_t i = 0; i < size; ++i) {
    bytes_.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
  }
}

void MessageWriter::F32(float value) { Number(std::bit_cast<std::uint32_t>(value), 4); }
void MessageWriter::F64(double value) { Number(std::bit_cast<std::uint64_t>(value), 8); }

void MessageWriter::Text(std::string_view text) {
  U32(static_cast<std::uint32_t>(text.size() + (cdr_ ? 1 : 0)));
  bytes_.insert(bytes_.end(), text.begin(), text.end());
  if (cdr_) bytes_.push_back(0);
}

void MessageWriter::Header(std::int64_t stamp_ns, std::string_view frame) {
  if (!cdr_) U32(0);  // ROS 1 has the number of the message here
  std::int64_t seconds = stamp_ns / kNsPerSecond;
  if (stamp_ns % kNsPerSecond < 0) --seconds;
  U32(static_cast<std::uint32_t>(seconds));
  U32(static_cast<std::uint32_t>(stamp_ns - seconds * kNsPerSecond));
  Text(frame);
}

void MessageWriter::Vector(const Eigen::Vector3d& vector) {
  for (int i = 0; i < 3; ++i) F64(vector[i]);
}

void MessageWriter::Motion(const Rigid3& motion) {
  Vector(motion.translation);
  for (int i = 0; i < 4; ++i) F64(motion.rotation.coeffs()[i]);  // x, y, z, w
}

void MessageWriter::Matrix(const Matrix6d& matrix) {
  for (int row = 0; row < 6; ++row) {
    for (int column = 0; column < 6; ++column) F64(matrix(row, column));
  }
}

void MessageWriter::Color(float red, float green, float blue) {
  for (const float part : {red, green, blue, 1.F}) F32(part);
}

}  // namespace plumbline::ros_node

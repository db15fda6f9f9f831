// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/units.h"
#include "plumbline/io/recordings/byte_cursor.h"
#include "plumbline/io/recordings/image_message.h"
#include "plumbline/io/recordings/transform_message.h"

#include <bit>
#include <cmath>
#include <string_view>

namespace plumbline {
namespace {

using ByteSpan = std::span<const std::uint8_t>;

constexpr std::size_t kCdrHeader = 4;
constexpr std::uint32_t kMostCoefficients = 64;

// CDR_BE or CDR_LE.
bool IsCdr(ByteSpan bytes) { return bytes.size() >= kCdrHeader && bytes[0] == 0 && bytes[1] <= 1; }

// Reads the fields of a message in their order.
class FieldReader {
 public:
  // With `cdr`, the bytes must be of IsCdr.
  FieldReader(bool cdr, ByteSpan bytes)
      : cdr_(cdr),
        big_endian_(cdr && bytes[1] == 0),
        cursor_(cdr ? bytes.subspan(kCdrHeader) : bytes) {}

  bool ok() const { return cursor_.ok(); }

  std::uint8_t U8() { return cursor_.U8(); }
  std::uint32_t U32() {
    Align(4);
    const std::uint32_t value = cursor_.U32();
    return big_endian_ ? __builtin_bswap32(value) : value;
  }
  double F64() {
    Align(8);
    const std::uint64_t value = cursor_.U64();
    return std::bit_cast<double>(big_endian_ ? __builtin_bswap64(value) : value);
  }
  std::string_view Text() {
    std::string_view text = cursor_.Text(U32());
    if (cdr_ && text.ends_with('\0')) text.remove_suffix(1);
    return text;
  }
  ByteSpan Bytes() { return cursor_.Take(U32()); }

  // Nanoseconds. ROS 1 counts seconds without a sign, ROS 2 with one.
  std::int64_t Time() {
    const std::uint32_t count = U32();
    const std::int64_t seconds = cdr_ ? std::int64_t{static_cast<std::int32_t>(count)} : count;
    return seconds * kNsPerSecond + U32();
  }

  // Reads std_msgs/Header.
  struct Header {
    std::int64_t stamp_ns = 0;
    std::string_view frame;
  };
  Header ReadHeader() {
    if (!cdr_) U32();  // ROS 1 has the number of the message here
    const std::int64_t stamp_ns = Time();
    return {stamp_ns, Text()};
  }

 private:
  void Align(std::size_t size) {
    if (cdr_) cursor_.Align(size);
  }

  bool cdr_, big_endian_;
  ByteCursor cursor_;
};

}  // namespace

std::optional<ImageMessage> ParseRosImage(bool cdr, bool compressed, ByteSpan bytes) {
  if (cdr && !IsCdr(bytes)) return std::nullopt;
  FieldReader fields(cdr, bytes);
  ImageMessage image;
  image.compressed = compressed;
  const FieldReader::Header header = fields.ReadHeader();
  image.stamp_ns = header.stamp_ns;
  image.frame = header.frame;
  if (!compressed) {
    image.height = fields.U32();
    image.width = fields.U32();
  }
  image.encoding = fields.Text();
  if (!compressed) {
    image.big_endian = fields.U8() != 0;
    image.step = fields.U32();
  }
  image.data = fields.Bytes();
  // Zeros alone are the fields of an empty image.
  if (!fields.ok() || image.data.empty()) return std::nullopt;
  return image;
}

std::optional<CalibrationMessage> ParseRosCalibration(bool cdr, ByteSpan bytes) {
  if (cdr && !IsCdr(bytes)) return std::nullopt;
  FieldReader fields(cdr, bytes);
  CalibrationMessage camera;
  fields.ReadHeader();
  camera.height = fields.U32();
  camera.width = fields.U32();
  camera.distortion_model = fields.Text();
  const std::uint32_t coefficients = fields.U32();
  if (coefficients > kMostCoefficients) return std::nullopt;
  for (std::uint32_t i = 0; i < coefficients; ++i) camera.d.push_back(fields.F64());
  for (double& number : camera.k) number = fields.F64();
  for (double& number : camera.r) number = fields.F64();
  for (double& number : camera.p) number = fields.F64();
  camera.binning_x = fields.U32();
  camera.binning_y = fields.U32();
  camera.roi_x = fields.U32();
  camera.roi_y = fields.U32();
  camera.roi_height = fields.U32();
  camera.roi_width = fields.U32();
  fields.U8();  // true to rectify the region
  return fields.ok() ? std::optional(std::move(camera)) : std::nullopt;
}

std::optional<InertialMessage> ParseRosInertial(bool cdr, ByteSpan bytes) {
  if (cdr && !IsCdr(bytes)) return std::nullopt;
  constexpr int kOrientation = 4, kCovariance = 9;
  FieldReader fields(cdr, bytes);
  InertialMessage message;
  message.stamp_ns = fields.ReadHeader().stamp_ns;
  for (int i = 0; i < kOrientation + kCovariance; ++i) fields.F64();
  // Returns false if the covariance marks the vector before it as not measured.
  const auto read_vector = [&](std::array<double, 3>& vector) {
    for (double& number : vector) number = fields.F64();
    const double first = fields.F64();
    for (int i = 1; i < kCovariance; ++i) fields.F64();
    return first != -1;
  };
  message.has_rate = read_vector(message.angular_rate);
  message.has_force = read_vector(message.specific_force);
  return fields.ok() ? std::optional(message) : std::nullopt;
}

std::optional<std::int64_t> ParseRosClock(bool cdr, ByteSpan bytes) {
  if (cdr && !IsCdr(bytes)) return std::nullopt;
  FieldReader fields(cdr, bytes);
  const std::int64_t stamp_ns = fields.Time();
  return fields.ok() ? std::optional(stamp_ns) : std::nullopt;
}

std::optional<std::vector<TransformMessage>> ParseRosTransforms(bool cdr, ByteSpan bytes) {
  if (cdr && !IsCdr(bytes)) return std::nullopt;
  FieldReader fields(cdr, bytes);
  std::vector<TransformMessage> transforms;
  const std::uint32_t count = fields.U32();
  for (std::uint32_t i = 0; i < count && fields.ok(); ++i) {
    const FieldReader::Header header = fields.ReadHeader();
    TransformMessage transform;
    transform.stamp_ns = header.stamp_ns;
    transform.parent = header.frame;
    transform.child = fields.Text();
    Rigid3& motion = transform.parent_from_child;
    for (int k = 0; k < 3; ++k) motion.translation[k] = fields.F64();
    for (int k = 0; k < 4; ++k) motion.rotation.coeffs()[k] = fields.F64();  // x, y, z, w
    const double norm = motion.rotation.norm();
    if (!motion.translation.allFinite() || !(norm > 0) || !std::isfinite(norm)) return std::nullopt;
    motion.rotation.normalize();
    transforms.push_back(std::move(transform));
  }
  return fields.ok() ? std::optional(std::move(transforms)) : std::nullopt;
}

}  // namespace plumbline

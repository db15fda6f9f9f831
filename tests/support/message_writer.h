// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace plumbline {

// Numbers as little-endian bytes.
inline std::string LittleEndian(std::uint64_t value, std::size_t size) {
  std::string bytes;
  for (std::size_t i = 0; i < size; ++i) bytes += static_cast<char>((value >> (8 * i)) & 255U);
  return bytes;
}

// Serialization of the messages of a test.
enum class Dialect { kRos1, kCdr, kBigEndianCdr, kProtobuf };

// Writes the fields of ROS messages: of ROS 1, or as CDR of ROS 2.
class RosFields {
 public:
  explicit RosFields(Dialect dialect)
      : cdr_(dialect != Dialect::kRos1), big_endian_(dialect == Dialect::kBigEndianCdr) {}

  void U8(std::uint8_t value) { body_ += static_cast<char>(value); }
  void U32(std::uint32_t value) { Number(value, 4); }
  void F64(double value) { Number(std::bit_cast<std::uint64_t>(value), 8); }
  void Text(const std::string& text) { Bytes(cdr_ ? text + '\0' : text); }
  void Bytes(std::string_view bytes) {
    U32(static_cast<std::uint32_t>(bytes.size()));
    body_ += bytes;
  }
  void Time(std::int64_t stamp_ns) {
    U32(static_cast<std::uint32_t>(stamp_ns / 1'000'000'000));
    U32(static_cast<std::uint32_t>(stamp_ns % 1'000'000'000));
  }
  void Header(std::int64_t stamp_ns, const std::string& frame) {
    if (!cdr_) U32(7);
    Time(stamp_ns);
    Text(frame);
  }

  std::string Take() const {
    return cdr_ ? std::string(big_endian_ ? "\0\0\0\0" : "\0\1\0\0", 4) + body_ : body_;
  }

 private:
  void Number(std::uint64_t value, std::size_t size) {
    while (cdr_ && body_.size() % size != 0) body_ += '\0';
    const std::string bytes = LittleEndian(value, size);
    body_ += big_endian_ ? std::string(bytes.rbegin(), bytes.rend()) : bytes;
  }

  bool cdr_, big_endian_;
  std::string body_;
};

// Writes the fields of protobuf messages.
class ProtobufFields {
 public:
  void Number(unsigned id, std::uint64_t value) {
    Varint(id << 3);
    Varint(value);
  }
  void Fixed32(unsigned id, std::uint32_t value) {
    Varint((id << 3) | 5U);
    body_ += LittleEndian(value, 4);
  }
  void Fixed64(unsigned id, std::uint64_t value) {
    Varint((id << 3) | 1U);
    body_ += LittleEndian(value, 8);
  }
  void Bytes(unsigned id, std::string_view bytes) {
    Varint((id << 3) | 2U);
    Varint(bytes.size());
    body_ += bytes;
  }
  void Stamp(unsigned id, std::int64_t stamp_ns) {
    ProtobufFields stamp;
    stamp.Number(1, static_cast<std::uint64_t>(stamp_ns / 1'000'000'000));
    stamp.Number(2, static_cast<std::uint64_t>(stamp_ns % 1'000'000'000));
    Bytes(id, stamp.Take());
  }
  std::string Take() const { return body_; }

 private:
  void Varint(std::uint64_t value) {
    for (; value >= 128; value >>= 7) body_ += static_cast<char>((value & 127U) | 128U);
    body_ += static_cast<char>(value);
  }

  std::string body_;
};

// An image of a test: raw pixels or (encoding "jpeg", "png") the bytes of a file.
struct TestImage {
  std::int64_t stamp_ns = 0;
  std::string encoding = "mono8";
  std::uint32_t width = 0, height = 0, step = 0;
  std::string data;
  std::string frame = "cam";
};

inline std::string RawImageMessage(Dialect dialect, const TestImage& image) {
  if (dialect == Dialect::kProtobuf) {
    ProtobufFields fields;
    fields.Stamp(1, image.stamp_ns);
    fields.Fixed32(2, image.width);
    fields.Fixed32(3, image.height);
    fields.Bytes(4, image.encoding);
    fields.Fixed32(5, image.step);
    fields.Bytes(6, image.data);
    fields.Bytes(7, image.frame);
    return fields.Take();
  }
  RosFields fields(dialect);
  fields.Header(image.stamp_ns, image.frame);
  fields.U32(image.height);
  fields.U32(image.width);
  fields.Text(image.encoding);
  fields.U8(0);
  fields.U32(image.step);
  fields.Bytes(image.data);
  return fields.Take();
}

inline std::string CompressedImageMessage(Dialect dialect, const TestImage& image) {
  if (dialect == Dialect::kProtobuf) {
    ProtobufFields fields;
    fields.Stamp(1, image.stamp_ns);
    fields.Bytes(4, image.frame);
    fields.Bytes(2, image.data);
    fields.Bytes(3, image.encoding);
    return fields.Take();
  }
  RosFields fields(dialect);
  fields.Header(image.stamp_ns, image.frame);
  fields.Text(image.encoding);
  fields.Bytes(image.data);
  return fields.Take();
}

// Camera parameters in the form of a calibration message.
struct TestCamera {
  std::uint32_t width = 8, height = 6;
  std::string model = "plumb_bob";
  std::vector<double> d = {0, 0, 0, 0, 0};
  std::array<double, 9> k = {5, 0, 4, 0, 5, 3, 0, 0, 1};
  std::array<double, 9> r = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  std::array<double, 12> p = {5, 0, 4, 0, 0, 5, 3, 0, 0, 0, 1, 0};
  std::uint32_t binning = 0;
};

inline std::string CalibrationMessageOf(Dialect dialect, const TestCamera& camera) {
  if (dialect == Dialect::kProtobuf) {
    ProtobufFields fields;
    fields.Stamp(1, 1);
    fields.Fixed32(2, camera.width);
    fields.Fixed32(3, camera.height);
    fields.Bytes(4, camera.model);
    const auto packed = [](const auto& numbers) {
      std::string bytes;
      for (const double number : numbers) {
        bytes += LittleEndian(std::bit_cast<std::uint64_t>(number), 8);
      }
      return bytes;
    };
    // One field of each encoding of repeated numbers.
    for (const double number : camera.d) fields.Fixed64(5, std::bit_cast<std::uint64_t>(number));
    fields.Bytes(6, packed(camera.k));
    fields.Bytes(7, packed(camera.r));
    fields.Bytes(8, packed(camera.p));
    return fields.Take();
  }
  RosFields fields(dialect);
  fields.Header(1, "cam");
  fields.U32(camera.height);
  fields.U32(camera.width);
  fields.Text(camera.model);
  fields.U32(static_cast<std::uint32_t>(camera.d.size()));
  for (const double number : camera.d) fields.F64(number);
  for (const double number : camera.k) fields.F64(number);
  for (const double number : camera.r) fields.F64(number);
  for (const double number : camera.p) fields.F64(number);
  fields.U32(camera.binning);
  fields.U32(camera.binning);
  for (int i = 0; i < 4; ++i) fields.U32(0);
  fields.U8(0);
  return fields.Take();
}

// A sensor_msgs/Imu whose rates and forces are given along x and z; nullopt: marked as not
// measured.
inline std::string InertialMessageOf(Dialect dialect,
                                     std::int64_t stamp_ns,
                                     std::optional<double> rate,
                                     std::optional<double> force) {
  RosFields fields(dialect);
  fields.Header(stamp_ns, "imu");
  for (const double q : {0, 0, 0, 1}) fields.F64(q);
  for (int i = 0; i < 9; ++i) fields.F64(i == 0 ? -1 : 0);
  const auto vector = [&](double x, double z, bool measured) {
    for (const double number : {x, 0.0, z}) fields.F64(number);
    for (int i = 0; i < 9; ++i) fields.F64(i == 0 && !measured ? -1 : 0);
  };
  vector(rate.value_or(0), 0, rate.has_value());
  vector(0, force.value_or(0), force.has_value());
  return fields.Take();
}

}  // namespace plumbline

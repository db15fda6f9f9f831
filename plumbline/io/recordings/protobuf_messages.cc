// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/units.h"
#include "plumbline/io/recordings/byte_cursor.h"
#include "plumbline/io/recordings/image_message.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <string_view>

namespace plumbline {
namespace {

using ByteSpan = std::span<const std::uint8_t>;

constexpr std::size_t kMostCoefficients = 64;

enum WireType : std::uint8_t { kVarint = 0, kFixed64 = 1, kBytes = 2, kFixed32 = 5 };

// A field: `number` holds a value of up to 64 bits, `bytes` a text, bytes or a message.
struct Field {
  std::uint32_t id = 0;
  std::uint32_t type = kVarint;
  std::uint64_t number = 0;
  ByteSpan bytes;

  bool IsNumber(std::uint32_t wanted_id, WireType wanted) const {
    return id == wanted_id && type == wanted;
  }
  bool IsBytes(std::uint32_t wanted_id) const { return IsNumber(wanted_id, kBytes); }
  std::string_view Text() const {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  }
};

std::optional<std::uint64_t> ReadVarint(ByteCursor& cursor) {
  std::uint64_t value = 0;
  for (unsigned shift = 0; shift < 64; shift += 7) {
    const std::uint8_t byte = cursor.U8();
    value |= static_cast<std::uint64_t>(byte & 0x7FU) << shift;
    if ((byte & 0x80U) == 0) return cursor.ok() ? std::optional(value) : std::nullopt;
  }
  return std::nullopt;
}

std::optional<Field> ReadField(ByteCursor& cursor) {
  const auto tag = ReadVarint(cursor);
  if (!tag || *tag >> 3 > std::numeric_limits<std::uint32_t>::max()) return std::nullopt;
  Field field;
  field.id = static_cast<std::uint32_t>(*tag >> 3);
  field.type = static_cast<std::uint32_t>(*tag & 7U);
  if (field.type == kVarint) {
    const auto value = ReadVarint(cursor);
    if (!value) return std::nullopt;
    field.number = *value;
  } else if (field.type == kFixed64) {
    field.number = cursor.U64();
  } else if (field.type == kFixed32) {
    field.number = cursor.U32();
  } else if (field.type == kBytes) {
    const auto size = ReadVarint(cursor);
    if (!size) return std::nullopt;
    field.bytes = cursor.Take(*size);
  } else {
    return std::nullopt;
  }
  return cursor.ok() ? std::optional(field) : std::nullopt;
}

// Calls `take` with every field. Returns false if the bytes are no message or `take` returns false.
template <class Take>
bool ForEachField(ByteSpan bytes, const Take& take) {
  ByteCursor cursor(bytes);
  while (cursor.remaining() > 0) {
    const std::optional<Field> field = ReadField(cursor);
    if (!field || !take(*field)) return false;
  }
  return true;
}

// Reads google.protobuf.Timestamp, or foxglove.Time, which has the same fields.
bool ReadStamp(ByteSpan bytes, std::int64_t& stamp_ns) {
  constexpr std::uint64_t kMostSeconds = 9'000'000'000;
  std::uint64_t seconds = 0, nanoseconds = 0;
  const bool whole = ForEachField(bytes, [&](const Field& field) {
    if (field.IsNumber(1, kVarint)) seconds = field.number;
    if (field.IsNumber(2, kVarint)) nanoseconds = field.number;
    return true;
  });
  if (!whole || seconds > kMostSeconds || nanoseconds >= kNsPerSecond) return false;
  stamp_ns =
      static_cast<std::int64_t>(seconds) * kNsPerSecond + static_cast<std::int64_t>(nanoseconds);
  return true;
}

// Reads a repeated double, which is packed into one field, or has one field for each number.
bool ReadDoubles(const Field& field, std::vector<double>& numbers) {
  if (field.type == kFixed64) {
    numbers.push_back(std::bit_cast<double>(field.number));
  } else if (field.type == kBytes && field.bytes.size() % 8 == 0 &&
             field.bytes.size() / 8 <= kMostCoefficients) {
    ByteCursor cursor(field.bytes);
    while (cursor.remaining() > 0) numbers.push_back(cursor.F64());
  } else {
    return false;
  }
  return numbers.size() <= kMostCoefficients;
}

// Copies a matrix; one that is missing is zero.
template <std::size_t kSize>
bool CopyMatrix(const std::vector<double>& numbers, std::array<double, kSize>& matrix) {
  if (!numbers.empty() && numbers.size() != kSize) return false;
  std::copy(numbers.begin(), numbers.end(), matrix.begin());
  return true;
}

bool TakeRaw(const Field& field, ImageMessage& image) {
  if (field.IsNumber(2, kFixed32)) image.width = static_cast<std::uint32_t>(field.number);
  if (field.IsNumber(3, kFixed32)) image.height = static_cast<std::uint32_t>(field.number);
  if (field.IsBytes(4)) image.encoding = field.Text();
  if (field.IsNumber(5, kFixed32)) image.step = static_cast<std::uint32_t>(field.number);
  if (field.IsBytes(6)) image.data = field.bytes;
  if (field.IsBytes(7)) image.frame = field.Text();
  return true;
}

bool TakeCompressed(const Field& field, ImageMessage& image) {
  if (field.IsBytes(2)) image.data = field.bytes;
  if (field.IsBytes(3)) image.encoding = field.Text();
  if (field.IsBytes(4)) image.frame = field.Text();
  return true;
}

}  // namespace

std::optional<ImageMessage> ParseProtobufImage(bool compressed, ByteSpan bytes) {
  ImageMessage image;
  image.compressed = compressed;
  const bool whole = ForEachField(bytes, [&](const Field& field) {
    if (field.IsBytes(1)) return ReadStamp(field.bytes, image.stamp_ns);
    return compressed ? TakeCompressed(field, image) : TakeRaw(field, image);
  });
  return whole ? std::optional(std::move(image)) : std::nullopt;
}

std::optional<CalibrationMessage> ParseProtobufCalibration(ByteSpan bytes) {
  CalibrationMessage camera;
  std::vector<double> k, r, p;
  const bool whole = ForEachField(bytes, [&](const Field& field) {
    if (field.IsNumber(2, kFixed32)) camera.width = static_cast<std::uint32_t>(field.number);
    if (field.IsNumber(3, kFixed32)) camera.height = static_cast<std::uint32_t>(field.number);
    if (field.IsBytes(4)) camera.distortion_model = field.Text();
    if (field.id == 5) return ReadDoubles(field, camera.d);
    if (field.id == 6) return ReadDoubles(field, k);
    if (field.id == 7) return ReadDoubles(field, r);
    if (field.id == 8) return ReadDoubles(field, p);
    return true;
  });
  if (!whole || !CopyMatrix(k, camera.k) || !CopyMatrix(r, camera.r) || !CopyMatrix(p, camera.p)) {
    return std::nullopt;
  }
  return camera;
}

}  // namespace plumbline

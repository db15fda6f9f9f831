// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace plumbline {

// Reads little-endian numbers and texts from bytes of unknown origin. Reading beyond the end gives
// zeros and empty texts, and ok() is false from then on, so that a record can be read as a whole
// before the check.
class ByteCursor {
 public:
  explicit ByteCursor(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  bool ok() const { return ok_; }
  std::size_t position() const { return at_; }
  std::size_t remaining() const { return bytes_.size() - at_; }

  std::uint8_t U8() { return static_cast<std::uint8_t>(Number(1)); }
  std::uint16_t U16() { return static_cast<std::uint16_t>(Number(2)); }
  std::uint32_t U32() { return static_cast<std::uint32_t>(Number(4)); }
  std::uint64_t U64() { return Number(8); }
  double F64() { return std::bit_cast<double>(Number(8)); }

  std::span<const std::uint8_t> Take(std::uint64_t count) {
    if (count > remaining()) {
      ok_ = false;
      at_ = bytes_.size();
      return {};
    }
    at_ += static_cast<std::size_t>(count);
    return bytes_.subspan(at_ - static_cast<std::size_t>(count), static_cast<std::size_t>(count));
  }
  std::string_view Text(std::uint64_t count) {
    const std::span<const std::uint8_t> bytes = Take(count);
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  }
  // Reads a text preceded by its length in 32 bits.
  std::string_view Text32() { return Text(U32()); }
  // Moves to the next position that is a multiple of `size`, counted from the first byte.
  void Align(std::size_t size) { Take((size - at_ % size) % size); }

 private:
  std::uint64_t Number(std::size_t size) {
    std::uint64_t value = 0;
    const std::span<const std::uint8_t> bytes = Take(size);
    for (std::size_t i = bytes.size(); i-- > 0;) value = (value << 8) | bytes[i];
    return value;
  }

  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
  bool ok_ = true;
};

}  // namespace plumbline

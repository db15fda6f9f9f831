// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/error.h"

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <type_traits>
#include <utility>

namespace plumbline {

// Numbers as bytes, little-endian whatever the machine. A writer and a reader are called alike, so
// that one function template describes a format for both directions.
class ByteWriter {
 public:
  static constexpr bool kReading = false;

  template <class T>
  requires(std::is_integral_v<T> || std::is_same_v<T, double>) void operator()(const T& value) {
    std::uint64_t bits = 0;
    if constexpr (std::is_same_v<T, double>) {
      bits = std::bit_cast<std::uint64_t>(value);
    } else {
      bits = static_cast<std::uint64_t>(value);
    }
    for (std::size_t i = 0; i < sizeof(T); ++i)
      bytes_ += static_cast<char>((bits >> (8 * i)) & 255U);
  }

  const std::string& bytes() const { return bytes_; }
  std::string Take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

// Throws InputError "<source>: ends early" when there are not enough bytes.
class ByteReader {
 public:
  static constexpr bool kReading = true;

  ByteReader(std::span<const std::uint8_t> bytes, std::string source)
      : bytes_(bytes), source_(std::move(source)) {}

  template <class T>
  requires(std::is_integral_v<T> || std::is_same_v<T, double>) void operator()(T& value) {
    if (remaining() < sizeof(T)) throw InputError(source_ + ": ends early");
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < sizeof(T); ++i) bits |= std::uint64_t{bytes_[at_ + i]} << (8 * i);
    at_ += sizeof(T);
    if constexpr (std::is_same_v<T, double>) {
      value = std::bit_cast<double>(bits);
    } else {
      value = static_cast<T>(bits);
    }
  }

  std::size_t remaining() const { return bytes_.size() - at_; }
  const std::string& source() const { return source_; }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
  std::string source_;
};

}  // namespace plumbline

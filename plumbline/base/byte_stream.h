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

template <class T>
concept StreamedNumber = std::is_integral_v<T> || std::is_same_v<T, double>;

// Writes numbers as bytes, little-endian on every machine. Writer and reader have the same
// interface, so that one function template describes a format for both directions (byte_format.h).
class ByteWriter {
 public:
  static constexpr bool kReading = false;

  template <StreamedNumber T>
  void operator()(const T& value) {
    std::uint64_t bits = 0;
    if constexpr (std::is_same_v<T, double>) {
      bits = std::bit_cast<std::uint64_t>(value);
    } else {
      bits = static_cast<std::uint64_t>(value);  // NOLINT(bugprone-signed-char-misuse): bytes alone
    }
    for (std::size_t i = 0; i < sizeof(T); ++i)
      bytes_ += static_cast<char>((bits >> (8 * i)) & 255U);
  }

  // Returns `count` bytes to be filled in by the caller, valid until the next call.
  std::span<char> Append(std::size_t count) {
    bytes_.resize(bytes_.size() + count);
    return {bytes_.data() + bytes_.size() - count, count};
  }

  const std::string& bytes() const { return bytes_; }
  std::string Take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

// Reads numbers. Throws InputError "<source>: ends early" if too few bytes are left.
class ByteReader {
 public:
  static constexpr bool kReading = true;

  ByteReader(std::span<const std::uint8_t> bytes, std::string source)
      : bytes_(bytes), source_(std::move(source)) {}

  template <StreamedNumber T>
  void operator()(T& value) {
    const std::span<const std::uint8_t> from = Take(sizeof(T));
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < sizeof(T); ++i) bits |= std::uint64_t{from[i]} << (8 * i);
    if constexpr (std::is_same_v<T, double>) {
      value = std::bit_cast<double>(bits);
    } else {
      value = static_cast<T>(bits);
    }
  }

  // Returns the next `count` bytes.
  std::span<const std::uint8_t> Take(std::size_t count) {
    if (remaining() < count) throw InputError(source_ + ": ends early");
    at_ += count;
    return bytes_.subspan(at_ - count, count);
  }

  std::size_t remaining() const { return bytes_.size() - at_; }
  const std::string& source() const { return source_; }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
  std::string source_;
};

}  // namespace plumbline

// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/byte_stream.h"
#include "plumbline/base/ids.h"

#include <array>
#include <bit>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace plumbline {

// Conversion of values to bytes and back, exact in both directions. Each type has one function
//
//   template <class Archive, Like<Features> T>
//   void Transfer(Archive& archive, T& value);
//
// for both directions: with a ByteWriter it writes a value, which may be const; with a ByteReader
// it reads into a default-constructed one. Overloads of other modules are in their byte_format.h
// and are found by the namespace of the archive. A change of one changes every format that contains
// it.

// True for T, const or not.
template <class T, class Plain>
concept Like = std::same_as<std::remove_const_t<T>, Plain>;

// Numbers that are not finite are refused on reading, since no stored value has any.
template <class Archive, StreamedNumber T>
void Transfer(Archive& archive, T& value) {
  archive(value);
  if constexpr (Archive::kReading && std::floating_point<T>) {
    if (!std::isfinite(value)) {
      throw InputError(archive.source() + ": expected finite numbers, found another");
    }
  }
}
template <class Archive, StreamedNumber T>
requires(!Archive::kReading) void Transfer(Archive& archive, const T& value) { archive(value); }

template <class Archive, class... Fields>
void TransferAll(Archive& archive, Fields&... fields) {
  (Transfer(archive, fields), ...);
}

// Transfers the number of items of a list. Every item takes a byte or more, so that a damaged
// number cannot ask for more memory than a multiple of what the file holds.
template <class Archive>
std::size_t TransferCount(Archive& archive, std::size_t count, std::size_t bytes_per_item = 1) {
  auto stored = static_cast<std::uint64_t>(count);
  archive(stored);
  if constexpr (Archive::kReading) {
    if (stored > archive.remaining() / bytes_per_item) {
      throw InputError(archive.source() + ": ends early");
    }
  }
  return static_cast<std::size_t>(stored);
}

template <class Archive, class Tag>
void Transfer(Archive& archive, Id<Tag>& id) {
  archive(id.value);
}
template <class Archive, class Tag>
requires(!Archive::kReading) void Transfer(Archive& archive, const Id<Tag>& id) {
  archive(id.value);
}

template <class Archive, Like<std::string> T>
void Transfer(Archive& archive, T& text) {
  const std::size_t size = TransferCount(archive, text.size());
  if constexpr (Archive::kReading) {
    const auto bytes = archive.Take(size);
    text.assign(bytes.begin(), bytes.end());
  } else {
    const auto bytes = archive.Append(size);
    text.copy(bytes.data(), size);
  }
}

template <class Archive, class T, std::size_t kSize>
void Transfer(Archive& archive, std::array<T, kSize>& items) {
  for (T& item : items) Transfer(archive, item);
}
template <class Archive, class T, std::size_t kSize>
void Transfer(Archive& archive, const std::array<T, kSize>& items) {
  for (const T& item : items) Transfer(archive, item);
}

template <class Archive, class A, class B>
requires(Archive::kReading) void Transfer(Archive& archive, std::pair<A, B>& pair) {
  TransferAll(archive, pair.first, pair.second);
}
template <class Archive, class A, class B>
requires(!Archive::kReading) void Transfer(Archive& archive, const std::pair<A, B>& pair) {
  TransferAll(archive, pair.first, pair.second);
}

template <class Archive, class T>
requires(Archive::kReading) void Transfer(Archive& archive, std::vector<T>& items) {
  const std::size_t count = TransferCount(archive, 0);
  for (std::size_t i = 0; i < count; ++i) Transfer(archive, items.emplace_back());
}
template <class Archive, class T>
requires(!Archive::kReading) void Transfer(Archive& archive, const std::vector<T>& items) {
  TransferCount(archive, items.size());
  for (const T& item : items) Transfer(archive, item);
}

// Keys must ascend; other maps are refused on reading.
template <class Archive, class Key, class T>
requires(Archive::kReading) void Transfer(Archive& archive, std::map<Key, T>& items) {
  const std::size_t count = TransferCount(archive, 0);
  for (std::size_t i = 0; i < count; ++i) {
    std::pair<Key, T> item;
    Transfer(archive, item);
    if (!items.empty() && !(items.rbegin()->first < item.first)) {
      throw InputError(archive.source() + ": expected ascending keys, found others");
    }
    items.emplace_hint(items.end(), std::move(item));
  }
}
template <class Archive, class Key, class T>
requires(!Archive::kReading) void Transfer(Archive& archive, const std::map<Key, T>& items) {
  TransferCount(archive, items.size());
  for (const auto& [key, item] : items) TransferAll(archive, key, item);
}

// Transfers one number of every item of a list, in as few bytes each as all of them fit into:
// doubles that are floats in four, small whole numbers in one. Bytes of equal weight lie side by
// side (all lowest ones, all second ones, ...), since they are alike and compress well. `get`
// returns the number of an item: a reference to an integer (not std::uint64_t) or a double.
template <class Archive, class Items, class Get>
void TransferColumn(Archive& archive, Items& items, const Get& get);

namespace column {

// Turns a signed number into an unsigned one that is small for small magnitudes.
inline std::uint64_t Folded(std::int64_t value) {
  return (static_cast<std::uint64_t>(value) << 1U) ^ static_cast<std::uint64_t>(value >> 63);
}
inline std::int64_t Unfolded(std::uint64_t bits) {
  return static_cast<std::int64_t>(bits >> 1U) ^ -static_cast<std::int64_t>(bits & 1U);
}

// Returns true if single precision represents the value exactly. It inspects the bits, since GCC 12
// drops conversions to float and back if it needs two of them together.
inline bool IsFloat(double value) {
  constexpr std::uint64_t kLost = (std::uint64_t{1} << 29U) - 1;
  constexpr std::uint64_t kLeast = 1023 - 126, kMost = 1023 + 127;
  const auto bits = std::bit_cast<std::uint64_t>(value);
  const std::uint64_t exponent = (bits >> 52U) & 0x7FFU;
  const bool zero = (bits << 1U) == 0;
  return zero || ((bits & kLost) == 0 && exponent >= kLeast && exponent <= kMost);
}

// The bits of each number, and the number of bytes of the widest.
struct Bits {
  std::vector<std::uint64_t> values;
  std::uint8_t bytes = 1;
};

template <class Items, class Get>
Bits BitsOf(const Items& items, const Get& get) {
  Bits bits;
  bits.values.reserve(items.size());
  using Number = std::remove_cvref_t<decltype(get(*items.begin()))>;
  if constexpr (std::is_same_v<Number, double>) {
    bits.bytes = 4;
    for (const auto& item : items) {
      if (!IsFloat(get(item))) bits.bytes = 8;
    }
    for (const auto& item : items) {
      const double value = get(item);
      bits.values.push_back(bits.bytes == 4
                                ? std::bit_cast<std::uint32_t>(static_cast<float>(value))
                                : std::bit_cast<std::uint64_t>(value));
    }
  } else {
    std::uint64_t all = 0;
    for (const auto& item : items) {
      bits.values.push_back(Folded(static_cast<std::int64_t>(get(item))));
      all |= bits.values.back();
    }
    while (bits.bytes < 8 && all >> (8U * bits.bytes) != 0) ++bits.bytes;
  }
  return bits;
}

template <class Number>
Number FromBits(std::uint64_t bits, std::size_t bytes, const std::string& source) {
  if constexpr (std::is_same_v<Number, double>) {
    return bytes == 4 ? double{std::bit_cast<float>(static_cast<std::uint32_t>(bits))}
                      : std::bit_cast<double>(bits);
  } else {
    const std::int64_t value = Unfolded(bits);
    if (!std::in_range<Number>(value)) {
      throw InputError(source + ": expected a number of " + std::to_string(sizeof(Number)) +
                       " bytes, found " + std::to_string(value));
    }
    return static_cast<Number>(value);
  }
}

}  // namespace column

template <class Archive, class Items, class Get>
void TransferColumn(Archive& archive, Items& items, const Get& get) {
  using Number = std::remove_cvref_t<decltype(get(*items.begin()))>;
  const std::size_t count = items.size();
  if constexpr (Archive::kReading) {
    std::uint8_t bytes = 0;
    archive(bytes);
    if (bytes < 1 || bytes > 8 || (std::is_same_v<Number, double> && bytes != 4 && bytes != 8)) {
      throw InputError(archive.source() + ": expected numbers of 1 to 8 bytes, found " +
                       std::to_string(bytes));
    }
    std::array<std::span<const std::uint8_t>, 8> planes;
    for (std::size_t k = 0; k < bytes; ++k) planes[k] = archive.Take(count);
    for (std::size_t i = 0; i < count; ++i) {
      std::uint64_t bits = 0;
      for (std::size_t k = 0; k < bytes; ++k) bits |= std::uint64_t{planes[k][i]} << (8 * k);
      get(items[i]) = column::FromBits<Number>(bits, bytes, archive.source());
    }
  } else {
    const column::Bits bits = column::BitsOf(items, get);
    archive(bits.bytes);
    for (std::size_t k = 0; k < bits.bytes; ++k) {
      const auto plane = archive.Append(count);
      for (std::size_t i = 0; i < count; ++i) {
        plane[i] = static_cast<char>((bits.values[i] >> (8 * k)) & 255U);
      }
    }
  }
}

}  // namespace plumbline

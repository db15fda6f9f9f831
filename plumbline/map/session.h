// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace plumbline {

// A universally unique name of a session or map, across files (RFC 9562). Made from contents
// instead of random numbers, version 8: the same input gives the same bytes.
struct Uuid {
  std::array<std::uint8_t, 16> bytes{};  // all 0: no name

  friend auto operator<=>(const Uuid&, const Uuid&) = default;
};

// Returns, for example, "f81d4fae-7dec-81d0-a765-00a0c91e6bf6".
std::string ToString(const Uuid& uuid);

// Returns the name of an object that the bytes describe.
Uuid UuidOf(const std::string& contents);

// One run of the camera. Stamps and frame numbers of different sessions may be the same.
struct Session {
  Uuid uuid;
  std::string program;  // version of the program that ran
  // Name of the data set, in files of earlier versions; otherwise empty.
  std::string data;
  std::int64_t first_stamp_ns = 0;
  std::int64_t last_stamp_ns = 0;
};

}  // namespace plumbline

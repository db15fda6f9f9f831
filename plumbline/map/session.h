// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace plumbline {

// A name that no two sessions or maps share, also of different files (RFC 9562). Not drawn at
// random but made from contents, version 8: the same input gives the same bytes.
struct Uuid {
  std::array<std::uint8_t, 16> bytes{};  // all 0: none

  friend auto operator<=>(const Uuid&, const Uuid&) = default;
};

// "f81d4fae-7dec-81d0-a765-00a0c91e6bf6".
std::string ToString(const Uuid& uuid);

// Made of bytes that describe the thing it is to name.
Uuid UuidOf(const std::string& contents);

// One run of the camera. Stamps and frame numbers of different sessions may be the same.
struct Session {
  Uuid uuid;
  std::string program;  // version that ran
  std::string data;     // name of the data set, in files of earlier versions; runs leave it empty
  std::int64_t first_stamp_ns = 0;
  std::int64_t last_stamp_ns = 0;
};

}  // namespace plumbline

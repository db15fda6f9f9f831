// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>

namespace plumbline {

// Converts a number >= 0 to the index type of containers.
constexpr std::size_t Index(int i) { return static_cast<std::size_t>(i); }

// A number that names one object of one kind. Ids of different kinds cannot be mixed. They are
// ordered, so that containers keyed by id iterate in the same order in every run.
template <class Tag>
struct Id {
  std::int64_t value = -1;

  friend auto operator<=>(const Id&, const Id&) = default;
  bool valid() const { return value >= 0; }
};

using FrameId = Id<struct FrameTag>;        // index of an input frame
using KeyFrameId = Id<struct KeyFrameTag>;  // order of creation
using PointId = Id<struct PointTag>;
using LineId = Id<struct LineTag>;
using MapId = Id<struct MapTag>;
// One run of the camera: index into the list of sessions.
using SessionId = Id<struct SessionTag>;

}  // namespace plumbline

template <class Tag>
struct std::hash<plumbline::Id<Tag>> {
  std::size_t operator()(const plumbline::Id<Tag>& id) const noexcept {
    return std::hash<std::int64_t>()(id.value);
  }
};

// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace plumbline {

// A stream of messages of one type, as clients and recordings are told of it.
struct FoxgloveChannel {
  std::string_view topic;
  std::string_view type;  // "foxglove.CompressedImage"
};

// The streams of a run, in this order; docs/viewer.md says what is in each.
enum class Stream : unsigned {
  kImage,
  kCalibration,
  kAnnotations,
  kPose,
  kTransform,
  kPoints,
  kLines,
  kUpdates
};
inline constexpr unsigned kStreams = 8;

std::span<const FoxgloveChannel> FoxgloveChannels();

// The types of all channels, and the types of their fields, as a google.protobuf.FileDescriptorSet:
// what the protocol and MCAP files have as the schema of a channel. Types of the package foxglove
// have the names and numbers of Foxglove's published schemas, and of their fields those that are
// written here.
const std::string& FoxgloveSchemas();

}  // namespace plumbline

// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace plumbline {

// A stream of messages of one type, for clients and recordings.
struct FoxgloveChannel {
  std::string_view topic;
  std::string_view type;  // "foxglove.CompressedImage"
};

// The streams of a run, in this order; docs/viewer.md describes them.
enum class Stream : unsigned {
  kImage,
  kCalibration,
  kAnnotations,
  kPose,
  kTransform,
  kPoints,
  kLines,
  kUpdates,
  kRightImage,
  kRightCalibration
};
inline constexpr unsigned kStreams = 10;

std::span<const FoxgloveChannel> FoxgloveChannels();

// Returns the types of all channels and of their fields as a google.protobuf.FileDescriptorSet, the
// schema of a channel in the protocol and in MCAP files. Types of the package foxglove have the
// names and numbers of Foxglove's published schemas, restricted to the fields written here.
const std::string& FoxgloveSchemas();

}  // namespace plumbline

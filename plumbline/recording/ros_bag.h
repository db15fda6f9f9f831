// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/recording/recording.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

namespace plumbline {

// Returns true if a file begins like a bag of any version.
bool BeginsAsBag(std::span<const std::uint8_t> bytes);

// Reads a ROS 1 bag of version 2.0 (wiki.ros.org/Bags/Format/2.0) from its first record to its
// last, and passes every message to `sink` in the order of the file. Chunks may be packed by bzip2
// or LZ4 or not at all. The index is only counted, which reveals a truncated or unclosed bag.
//
// Throws InputError, which names the byte, for another kind of file, and if it is damaged, ends
// early, is encrypted or has no index (`rosbag reindex` makes it anew). Cost: reading and unpacking
// the file once.
std::unique_ptr<Recording> ReadBag(const std::filesystem::path& path, const MessageSink& sink);

}  // namespace plumbline

// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/recording/recording.h"

#include <filesystem>
#include <memory>
#include <vector>

namespace plumbline {

// Reads the files of one recording of ROS 2 in their order: .db3 (sqlite_bag.h) and .mcap (mcap.h),
// each plain or packed as a whole (.zstd: it is unpacked into a temporary file). Of a damaged or
// truncated file all readable messages are read, and the rest becomes a note. `path` is the file or
// the folder of files, for error messages. Throws InputError if no file can be read.
std::unique_ptr<Recording> ReadRosbag2(const std::filesystem::path& path,
                                       const std::vector<std::filesystem::path>& files,
                                       const MessageSink& sink);

}  // namespace plumbline

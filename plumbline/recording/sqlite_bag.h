// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/recording/recording.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string_view>

namespace plumbline {

// The bytes with which SQLite's files begin.
inline constexpr std::string_view kSqliteMagic{"SQLite format 3\0", 16};

// Whether a file begins as SQLite's do.
bool BeginsAsSqlite(std::span<const std::uint8_t> bytes);

// Reads a .db3 file of ROS 2 (rosbag2's storage `sqlite3`, all its versions: tables `topics` and
// `messages`) from its first message to its last, and hands those of the types that FormOf knows to
// `sink`. Others are not read. The file is neither changed nor locked. Where a recorder's journal
// (-wal, -journal) lies beside it, both are copied to a temporary folder, and the journal is played
// back there.
//
// Messages on damaged pages, or behind the end of a file that was cut short, are left out, with a
// note. `name` is what messages call the file, where it is not its path. Throws InputError for what
// is no such file. Cost: reading the file once; later, the pages of each message again.
std::unique_ptr<Recording> ReadSqliteBag(const std::filesystem::path& path,
                                         const MessageSink& sink,
                                         const std::filesystem::path& name = {});

}  // namespace plumbline

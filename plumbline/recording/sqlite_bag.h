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

// First bytes of SQLite's files.
inline constexpr std::string_view kSqliteMagic{"SQLite format 3\0", 16};

// Returns true if a file begins like SQLite's.
bool BeginsAsSqlite(std::span<const std::uint8_t> bytes);

// Reads a .db3 file of ROS 2 (rosbag2's storage `sqlite3`, all its versions: tables `topics` and
// `messages`) from its first message to its last, and passes those of the types known to FormOf to
// `sink`. Others are not read. The file is neither changed nor locked. If a recorder's journal
// (-wal, -journal) lies beside it, both are copied to a temporary folder, and the journal is
// applied there.
//
// Messages on damaged pages, or after the end of a truncated file, are left out, with a note.
// Messages use `name`, if given, instead of the path. Throws InputError for another kind of file.
// Cost: reading the file once; later, the pages of each message again.
std::unique_ptr<Recording> ReadSqliteBag(const std::filesystem::path& path,
                                         const MessageSink& sink,
                                         const std::filesystem::path& name = {});

}  // namespace plumbline

// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/saved_run.h"

#include <filesystem>
#include <string_view>

namespace plumbline {

// The first bytes of checkpoint files. Their line ends reveal a transfer as text.
inline constexpr std::string_view kCheckpointMagic = "PLBRUN\r\n";

// Writes a run in the middle (System::Save) to a file. The file is replaced whole once everything
// is on the disk, so that there is always a complete one. Nothing is rounded, and the same run
// gives the same bytes. Throws InputError "cannot write <path>: <reason>".
void SaveCheckpoint(const std::filesystem::path& path, const SavedRun& run);

// Reads a checkpoint file. Throws InputError naming the file when it is missing, no checkpoint, of
// another version, cut short, damaged (checksums), or its maps contradict themselves.
// System::Resume finds what is wrong with the rest.
SavedRun LoadCheckpoint(const std::filesystem::path& path);

}  // namespace plumbline

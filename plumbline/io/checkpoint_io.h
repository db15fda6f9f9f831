// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/saved_run.h"

#include <filesystem>
#include <string_view>

namespace plumbline {

// What such files begin with; line ends show a transfer as text.
inline constexpr std::string_view kCheckpointMagic = "PLBRUN\r\n";

// Writes a run in the middle (System::Save) to a file, which is replaced whole once all of it is on
// the disk: whatever happens meanwhile, the last complete one is there. Nothing is rounded, and the
// same run gives the same bytes. Throws InputError "cannot write <path>: <reason>".
void SaveCheckpoint(const std::filesystem::path& path, const SavedRun& run);

// Reads such a file. Throws InputError naming the file when it is missing, no checkpoint, of
// another version, cut short, damaged (checksums), or its maps contradict themselves; what is
// wrong with the rest, System::Resume finds.
SavedRun LoadCheckpoint(const std::filesystem::path& path);

}  // namespace plumbline

// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace plumbline {

// Throws InputError, which names the file, when the folder for the tables of an experiment, or of a
// group, has one that these would replace and no experiment wrote. Those of an earlier call are
// known by its results.json, which is written before the others. Touches nothing.
void CheckResultsFolder(const std::filesystem::path& out);

}  // namespace plumbline

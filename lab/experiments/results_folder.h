// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace plumbline {

// Throws InputError, which names the file, if the folder for the tables of an experiment, or of a
// group, has a file that would be replaced and was not written by an experiment. Those of an
// earlier call are recognized by its results.json, which is written before the others. Changes
// nothing.
void CheckResultsFolder(const std::filesystem::path& out);

}  // namespace plumbline

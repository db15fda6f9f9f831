// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/eval/figure.h"

#include <filesystem>

namespace plumbline {

// InputError unless the extension of the file is one that WriteFigure knows: to be asked before the
// work is done.
void CheckFigureName(const std::filesystem::path& path);

// Writes a figure as .svg or .png, by the extension of the file; InputError for any other, and
// where the file cannot be written.
void WriteFigure(const std::filesystem::path& path, const Figure& figure);

}  // namespace plumbline

// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/eval/figure.h"

#include <filesystem>

namespace plumbline {

// Writes a figure as .svg or .png, by the extension of the file; InputError for any other, and
// where the file cannot be written.
void WriteFigure(const std::filesystem::path& path, const Figure& figure);

}  // namespace plumbline

// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/eval/figure.h"

#include <filesystem>
#include <string>

namespace plumbline {

// InputError unless the extension of the file is one that FigureBytes knows: to be asked before the
// work is done.
void CheckFigureName(const std::filesystem::path& path);

// Returns the bytes of a figure as .svg or .png, by the extension of the file that they are for;
// InputError for any other.
std::string FigureBytes(const std::filesystem::path& path, const Figure& figure);

}  // namespace plumbline

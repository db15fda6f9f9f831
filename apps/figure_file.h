// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/report/figure.h"

#include <filesystem>
#include <string>

namespace plumbline {

// Throws InputError unless FigureBytes supports the extension of the file: a check before the work.
void CheckFigureName(const std::filesystem::path& path);

// Returns the bytes of a figure as .svg or .png, by the extension of its file; throws InputError
// for any other.
std::string FigureBytes(const std::filesystem::path& path, const Figure& figure);

}  // namespace plumbline

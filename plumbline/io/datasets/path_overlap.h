// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace plumbline {

// Returns true if two paths name the same file or folder, whatever their links, `..` and spelling.
// Missing paths are the same if files made there would be the same.
bool IsSamePath(const std::filesystem::path& a, const std::filesystem::path& b);

// Returns true if a path is a folder or lies in it, at any depth; links are followed.
bool IsWithin(const std::filesystem::path& path, const std::filesystem::path& folder);

}  // namespace plumbline

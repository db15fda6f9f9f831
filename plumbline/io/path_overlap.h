// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace plumbline {

// Whether two paths name the same file or folder, whatever links, `..` and spelling of them. What
// does not exist yet is the same as what would be made at the same place.
bool IsSamePath(const std::filesystem::path& a, const std::filesystem::path& b);

// Whether a path is a folder or lies in it, at any depth; links are followed.
bool IsWithin(const std::filesystem::path& path, const std::filesystem::path& folder);

}  // namespace plumbline

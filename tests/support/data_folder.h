// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

namespace plumbline {

// Returns a file or folder of the real sequences: in the folder of the environment variable
// PLUMBLINE_DATA, or else beside the source tree. nullopt if it is missing; skip the test then. For
// test programs with REAL_DATA in their plumbline_tests().
inline std::optional<std::filesystem::path> FindData(const std::string& name) {
  namespace fs = std::filesystem;
  const char* from_environment = std::getenv("PLUMBLINE_DATA");
  const fs::path root = from_environment != nullptr ? fs::path(from_environment)
                                                    : fs::path(PLUMBLINE_DATA_BESIDE_SOURCE);
  if (!fs::exists(root / name)) return std::nullopt;
  return root / name;
}

}  // namespace plumbline

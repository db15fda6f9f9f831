// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

namespace plumbline {

// A file or folder of the real sequences: in the folder that the environment variable
// PLUMBLINE_DATA names, or else beside the source tree. nullopt when it is not there; skip the test
// then.
inline std::optional<std::filesystem::path> FindData(const std::string& name) {
  namespace fs = std::filesystem;
  const char* from_environment = std::getenv("PLUMBLINE_DATA");
  const fs::path source = fs::path(__FILE__).parent_path().parent_path().parent_path();
  const fs::path root =
      from_environment != nullptr ? fs::path(from_environment) : source / ".." / "shared" / "data";
  if (!fs::exists(root / name)) return std::nullopt;
  return root / name;
}

}  // namespace plumbline

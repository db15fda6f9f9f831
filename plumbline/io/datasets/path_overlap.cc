// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/datasets/path_overlap.h"

#include <system_error>

namespace plumbline {
namespace {

namespace fs = std::filesystem;

// Returns an absolute path, with links followed as far as there are files, and without a separator
// at the end.
fs::path Resolved(const fs::path& path) {
  std::error_code error;
  fs::path resolved = fs::weakly_canonical(fs::absolute(path, error), error);
  if (error) resolved = fs::absolute(path, error).lexically_normal();
  return resolved.has_filename() ? resolved : resolved.parent_path();
}

bool IsSameResolved(const fs::path& a, const fs::path& b) {
  std::error_code error;
  return a == b || (fs::equivalent(a, b, error) && !error);
}

}  // namespace

bool IsSamePath(const fs::path& a, const fs::path& b) {
  return IsSameResolved(Resolved(a), Resolved(b));
}

bool IsWithin(const fs::path& path, const fs::path& folder) {
  const fs::path end = Resolved(folder);
  for (fs::path at = Resolved(path);; at = at.parent_path()) {
    if (IsSameResolved(at, end)) return true;
    if (at == at.parent_path()) return false;
  }
}

}  // namespace plumbline

// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/recordings/temporary_folder.h"

#include "plumbline/base/error.h"

#include <string>
#include <system_error>

#include <stdlib.h>

namespace plumbline {

TemporaryFolder::TemporaryFolder() {
  std::error_code error;
  std::string name = (std::filesystem::temp_directory_path(error) / "plumbline_XXXXXX").string();
  if (error || ::mkdtemp(name.data()) == nullptr) {
    throw InputError(name + ": no folder for temporary files can be made (TMPDIR names another)");
  }
  path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace plumbline

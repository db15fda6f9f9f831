// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/command_outputs.h"

#include "plumbline/base/error.h"
#include "plumbline/base/input_file.h"
#include "plumbline/io/path_overlap.h"
#include "plumbline/report/run_folder.h"

#include <system_error>

#include <fmt/core.h>

namespace plumbline {

void CheckReplacesItsKind(std::string_view option,
                          const std::filesystem::path& file,
                          const FileKind& kind) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return;
  if (std::filesystem::file_size(file, error) == 0) return;
  if (FileBeginsWith(file, kind.begin) && (kind.is_one == nullptr || kind.is_one(file))) return;
  throw InputError(fmt::format("{} {}: expected {} to replace, or a new file, found another file",
                               option,
                               file.string(),
                               kind.name));
}

void CheckApartFromEachOther(
    std::span<const std::pair<std::string_view, std::filesystem::path>> outputs) {
  for (auto output = outputs.begin(); output != outputs.end(); ++output) {
    for (auto before = outputs.begin(); before != output; ++before) {
      if (!IsSamePath(output->second, before->second)) continue;
      throw InputError(fmt::format("{} {}: expected another file than that of {}",
                                   output->first,
                                   output->second.string(),
                                   before->first));
    }
  }
}

void CheckKeepsResults(std::string_view option, const std::filesystem::path& file) {
  std::error_code error;
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
  // A list that is damaged protects results as well; runs of older versions have none.
  const bool of_run = std::filesystem::exists(folder / RunManifest::kFile, error) ||
                      ReadRunManifest(folder).has_value();
  if (!of_run) return;
  CheckNoResult(option, file, folder);
}

}  // namespace plumbline

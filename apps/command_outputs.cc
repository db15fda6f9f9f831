// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/command_outputs.h"

#include "plumbline/base/error.h"
#include "plumbline/base/input_file.h"
#include "plumbline/io/datasets/path_overlap.h"
#include "plumbline/io/map_file/map_io.h"
#include "plumbline/report/run_folder.h"

#include <cstddef>
#include <fstream>
#include <regex>
#include <string>
#include <system_error>

#include <fmt/core.h>

namespace plumbline {
namespace {

// A trajectory of ours begins with a row of FormatTum: a time and seven numbers, each with nine
// decimals.
bool BeginsAsOurTrajectory(const std::filesystem::path& path) {
  constexpr std::size_t kLongestRow = 400;
  static const std::regex row(R"(-?[0-9]+\.[0-9]{9}( -?[0-9]+\.[0-9]{9}){7})");
  std::ifstream file(path, std::ios::binary);
  std::string start(kLongestRow, '\0');
  file.read(start.data(), static_cast<std::streamsize>(start.size()));
  start.resize(static_cast<std::size_t>(file.gcount()));
  return std::regex_match(start.substr(0, start.find('\n')), row);
}

}  // namespace

FileKind MapFileKind() { return {"a map", kMapMagic}; }

FileKind TrajectoryFileKind() { return {"a trajectory by plumbline", "", &BeginsAsOurTrajectory}; }

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
  // A list that is damaged protects results as well.
  if (!std::filesystem::exists(folder / kRunList, error)) return;
  CheckNoResult(option, file, folder);
}

void CheckOutput(std::string_view option,
                 const std::filesystem::path& output,
                 std::span<const std::filesystem::path> inputs,
                 const FileKind& kind) {
  if (output == "-")
    throw InputError(fmt::format("{}: expected a file or folder, found -", option));
  std::error_code error;
  for (const std::filesystem::path& input : inputs) {
    if (!std::filesystem::equivalent(output, input, error)) continue;
    throw InputError(fmt::format("{} {}: expected another file than {}, which is read",
                                 option,
                                 output.string(),
                                 input.string()));
  }
  CheckKeepsResults(option, output);
  CheckReplacesItsKind(option, output, kind);
}

}  // namespace plumbline

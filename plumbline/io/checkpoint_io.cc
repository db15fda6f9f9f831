// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/checkpoint_io.h"

#include "plumbline/base/error.h"
#include "plumbline/io/map_sections.h"
#include "plumbline/io/section_file.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/core.h>

namespace plumbline {
namespace {

// Has to be increased with every change of what System::Save writes, and with the version of map
// files.
constexpr std::uint32_t kVersion = 6;

// The sections after those of the maps: the input; the state, in as many sections as it needs; the
// end.
enum SectionKind : std::uint32_t { kInput = kAfterMaps, kState = kAfterMaps + 1, kEnd };

constexpr std::size_t kSectionBytes = std::size_t{1} << 21;

void CheckPreamble(const SectionReader& file) {
  const auto version = VersionOf(file, kCheckpointMagic);
  if (!version) {
    throw InputError(file.source() + ": expected a Plumbline checkpoint, found another file");
  }
  if (*version != kVersion) {
    throw InputError(fmt::format("{}: expected a checkpoint of version {}, found version {}",
                                 file.source(),
                                 kVersion,
                                 *version));
  }
}

}  // namespace

void SaveCheckpoint(const std::filesystem::path& path, const SavedRun& run) {
  SectionWriter file(path, VersionedPreamble(kCheckpointMagic, kVersion));
  WriteMapSections(run.maps.atlas, run.maps.context, MapId{}, file);
  file.Write(kInput, run.input);
  const std::string_view state = run.state;
  for (std::size_t at = 0; at < state.size(); at += kSectionBytes) {
    file.Write(kState, state.substr(at, kSectionBytes));
  }
  file.Write(kEnd, {});
  file.Commit();
}

SavedRun LoadCheckpoint(const std::filesystem::path& path) {
  SectionReader file(path, kVersionedPreambleBytes);
  CheckPreamble(file);
  SavedRun run;
  run.maps = ReadMapSections(file);
  run.input = NextSectionOfKind(file, kInput);
  while (true) {
    const SectionReader::Section section = file.Next();
    if (section.kind == kEnd && section.contents.empty()) break;
    if (section.kind != kState) {
      throw InputError(fmt::format("{}: expected the state of a run, found a section of kind {}",
                                   file.source(),
                                   section.kind));
    }
    run.state += section.contents;
  }
  if (file.remaining() != 0) {
    throw InputError(file.source() + ": expected the end, found more bytes");
  }
  return run;
}

}  // namespace plumbline

// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/byte_stream.h"
#include "plumbline/base/error.h"
#include "plumbline/io/map_file/map_io.h"
#include "plumbline/io/map_file/section_file.h"

#include "fuzz/input_folder.h"
#include <algorithm>
#include <string>

namespace plumbline {
namespace {

std::string Preamble(std::uint32_t version) {
  ByteWriter preamble;
  for (const char c : std::string_view("PLBMAP\r\n")) preamble(static_cast<std::uint8_t>(c));
  preamble(version);
  return preamble.Take();
}

// A file of version 2 with these sections: for each its kind (a byte), the size of its contents
// (two bytes, less where the input ends), the contents.
void WriteSections(const std::filesystem::path& path, std::string_view sections) {
  SectionWriter file(path, Preamble(2));
  while (sections.size() >= 3) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(sections[i]); };
    const std::uint32_t kind = byte(0);
    const std::size_t size = byte(1) + 256U * byte(2);
    sections.remove_prefix(3);
    file.Write(kind, sections.substr(0, size));
    sections.remove_prefix(std::min(size, sections.size()));
  }
  file.Commit();
}

}  // namespace
}  // namespace plumbline

// Map files. After a first 'S' the input is the sections of a file of version 2
// (docs/adr/0009-map-file-format.md), which get the checksums that fit
// and that no mutation would find; otherwise it is the whole file.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace plumbline;
  static const InputFolder folder;
  std::filesystem::path path = folder.path() / "map.plb";
  const std::string_view text = AsText(data, size);
  if (text.starts_with('S')) {
    WriteSections(path, text.substr(1));
  } else {
    path = folder.Write("map.plb", text);
  }
  const std::filesystem::path again = folder.path() / "again.plb";
  try {
    const SavedAtlas saved = LoadAtlas(path);
    for (const auto& [id, map] : saved.atlas.maps()) {
      map.CheckInvariants();
      for (const auto& [keyframe, removed] : map.Record().removed_keyframes) map.PoseOf(keyframe);
      for (const auto& [point, kept] : map.Record().merged_points) map.Current(point);
    }
    SaveAtlas(again, saved.atlas, saved.context);
  } catch (const InputError&) {
    return 0;
  }
  (void)LoadAtlas(again);
  return 0;
}

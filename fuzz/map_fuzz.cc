// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/error.h"
#include "plumbline/io/byte_stream.h"
#include "plumbline/io/crc32.h"
#include "plumbline/io/map_io.h"

#include "fuzz/input_folder.h"
#include <string>

// Map files. After a first 'B' the input is the body (docs/adr/0009-map-file-format.md) and gets a
// header that fits, which no mutation would find; otherwise it is the whole file.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace plumbline;
  static const InputFolder folder;
  std::string file(AsText(data, size));
  if (size > 0 && data[0] == 'B') {
    const std::span<const std::uint8_t> body(data + 1, size - 1);
    ByteWriter header;
    for (const char c : std::string_view("PLBMAP\r\n")) header(static_cast<std::uint8_t>(c));
    header(std::uint32_t{1});
    header(Crc32(body));
    header(static_cast<std::uint64_t>(body.size()));
    file = header.Take() + file.substr(1);
  }
  const std::filesystem::path path = folder.Write("map.plb", file);
  try {
    const SavedMap saved = LoadMap(path);
    saved.map.CheckInvariants();
    SaveMap(folder.path() / "again.plb", saved.camera, saved.rectified_from_left, saved.map);
  } catch (const InputError&) {
    return 0;
  }
  (void)LoadMap(folder.path() / "again.plb");
  return 0;
}

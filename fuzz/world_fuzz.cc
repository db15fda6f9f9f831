// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/error.h"
#include "plumbline/io/export/obj_lines.h"
#include "worlds/true_world.h"

#include "fuzz/input_folder.h"

namespace {

using namespace plumbline;

void ReadAndWriteLines(const InputFolder& folder, const std::filesystem::path& file) {
  const auto lines = ReadTrueLines(file);
  WriteTrueLines(folder.path() / "again.csv", lines);
  const auto again = ReadTrueLines(folder.path() / "again.csv");
  PLUMBLINE_CHECK(again.size() == lines.size(), "lines come back");
  for (std::size_t i = 0; i < lines.size(); ++i) {
    PLUMBLINE_CHECK(again[i].segment.start == lines[i].segment.start &&
                        again[i].segment.end == lines[i].segment.end &&
                        again[i].kind == lines[i].kind && again[i].visible == lines[i].visible,
                    "a line comes back");
    (void)lines[i].VisibleFrames();
  }
}

void ReadAndWriteSurfaces(const InputFolder& folder, const std::filesystem::path& file) {
  const auto surfaces = ReadSurfaces(file);
  WriteSurfaces(folder.path() / "again.csv", surfaces);
  PLUMBLINE_CHECK(ReadSurfaces(folder.path() / "again.csv").size() == surfaces.size(),
                  "surfaces come back");
}

}  // namespace

// Lines and surfaces of known worlds and lines of OBJ files: the first byte, L, S or another, says
// which. What was read can be written and read again.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const InputFolder folder;
  if (size == 0) return 0;
  const std::filesystem::path file = folder.Write("input", AsText(data + 1, size - 1));
  try {
    if (data[0] == 'L') {
      ReadAndWriteLines(folder, file);
    } else if (data[0] == 'S') {
      ReadAndWriteSurfaces(folder, file);
    } else {
      (void)ReadObjLines(file);
    }
  } catch (const InputError&) {
  }
  return 0;
}

// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/dataset.h"

#include "fuzz/input_folder.h"

namespace plumbline {
namespace {

const std::vector<InputFile>& Files() {
  static const std::vector<InputFile> files = {
      {"rgb.txt", "# colour\n1.000 1.pgm\n1.033 1.pgm\n"},
      {"depth.txt", "# depth\n1.010 1.pgm\n1.021 1.pgm\n"},
      {"groundtruth.txt", "1.0 0 0 0 0 0 0 1\n"},
      {"camera.yaml", "size: [8, 6]\nintrinsics: [5, 5, 4, 3]\ndepth_factor: 1000\n"},
      {"1.pgm", SmallImage()}};
  return files;
}

const InputFolder& Folder() {
  static const InputFolder folder;
  static const bool written = [] {
    for (const InputFile& file : Files()) folder.Write(file.name, file.good);
    return true;
  }();
  (void)written;
  return folder;
}

}  // namespace
}  // namespace plumbline

// Files of a TUM folder (not the image, which others decode).
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace plumbline;
  static const std::vector<InputFile> texts(Files().begin(), Files().end() - 1);
  ParseWithOneFileReplaced(
      Folder(), texts, AsText(data, size), [] { (void)OpenDataset(Folder().path()); });
  return 0;
}

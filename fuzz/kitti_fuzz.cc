// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/dataset.h"

#include "fuzz/input_folder.h"

namespace plumbline {
namespace {

const std::vector<InputFile>& Files() {
  static const std::vector<InputFile> files = {
      {"calib.txt", "P0: 700 0 4 0 0 710 3 0 0 0 1 0\nP1: 700 0 4 -380 0 710 3 0 0 0 1 0\n"},
      {"times.txt", "0.0\n1.037000e-01\n"},
      {"poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 0 0 1 0 0 0 0 1 1\n"},
      {"image_1/000000.pgm", SmallImage()},
      {"image_0/000000.pgm", SmallImage()}};
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

// Files of a KITTI folder (not the images, which others decode).
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace plumbline;
  static const std::vector<InputFile> texts(Files().begin(), Files().end() - 2);
  ParseWithOneFileReplaced(
      Folder(), texts, AsText(data, size), [] { (void)OpenDataset(Folder().path()); });
  return 0;
}

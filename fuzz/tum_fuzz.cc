// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "fuzz/fuzzed_dataset.h"

namespace plumbline {
namespace {

FuzzedDataset Make() {
  return {{{"rgb.txt", "# colour\n1.000 1.pgm\n1.033 1.pgm\n"},
           {"depth.txt", "# depth\n1.010 1.pgm\n1.021 1.pgm\n"},
           {"groundtruth.txt", "1.0 0 0 0 0 0 0 1\n"},
           {"camera.yaml", "size: [8, 6]\nintrinsics: [5, 5, 4, 3]\ndepth_factor: 1000\n"}},
          {"1.pgm"}};
}

}  // namespace
}  // namespace plumbline

// Files of a TUM folder.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const plumbline::FuzzedDataset dataset = plumbline::Make();
  dataset.OpenWith(plumbline::AsText(data, size));
  return 0;
}

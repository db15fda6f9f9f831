// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "fuzz/fuzzed_dataset.h"

namespace plumbline {

// Files of a TUM folder.
FuzzedDataset MakeFuzzedDataset() {
  return {{{"rgb.txt", "# colour\n1.000 1.pgm\n1.033 1.pgm\n"},
           {"depth.txt", "# depth\n1.010 1.pgm\n1.021 1.pgm\n"},
           {"groundtruth.txt", "1.0 0 0 0 0 0 0 1\n"},
           {"camera.yaml", "size: [8, 6]\nintrinsics: [5, 5, 4, 3]\ndepth_factor: 1000\n"}},
          {"1.pgm"}};
}

}  // namespace plumbline

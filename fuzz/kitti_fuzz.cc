// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "fuzz/fuzzed_dataset.h"

namespace plumbline {

// Files of a KITTI folder.
FuzzedDataset MakeFuzzedDataset() {
  return {{{"calib.txt", "P0: 700 0 4 0 0 710 3 0 0 0 1 0\nP1: 700 0 4 -380 0 710 3 0 0 0 1 0\n"},
           {"times.txt", "0.0\n1.037000e-01\n"},
           {"poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 0 0 1 0 0 0 0 1 1\n"}},
          {"image_1/000000.pgm", "image_0/000000.pgm"}};
}

}  // namespace plumbline

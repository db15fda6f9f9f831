// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "fuzz/fuzzed_dataset.h"

namespace plumbline {

// Files of a KITTI raw drive whose images may be rectified or as taken.
FuzzedDataset MakeFuzzedDataset() {
  return {{{"calib_cam_to_cam.txt",
            "S_00: 8 6\nK_00: 7 0 4 0 7 3 0 0 1\nD_00: -0.3 0.1 0 0 0\n"
            "R_00: 1 0 0 0 1 0 0 0 1\nT_00: 0 0 0\nS_rect_00: 8 6\nR_rect_00: 1 0 0 0 1 0 0 0 1\n"
            "P_rect_00: 7 0 4 0 0 7 3 0 0 0 1 0\n"
            "S_01: 8 6\nK_01: 7 0 4 0 7 3 0 0 1\nD_01: -0.3 0.1 0 0 0\n"
            "R_01: 1 0 0 0 1 0 0 0 1\nT_01: -0.5 0 0\nS_rect_01: 8 6\n"
            "P_rect_01: 7 0 4 -3.5 0 7 3 0 0 0 1 0\n"},
           {"image_00/timestamps.txt",
            "2011-09-26 13:02:25.964389445\n2011-09-26 13:02:26.074343777\n"}},
          {"image_01/data/0000000000.pgm", "image_00/data/0000000000.pgm"}};
}

}  // namespace plumbline

// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "fuzz/fuzzed_dataset.h"

namespace plumbline {

// Files of a EuRoC folder.
FuzzedDataset MakeFuzzedDataset() {
  const std::string list = "#timestamp [ns],filename\n100,1.pgm\n200,2.pgm\n";
  const std::string sensor =
      "T_BS:\n  cols: 4\n  rows: 4\n  data: [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]\nrate_hz: 20\n"
      "resolution: [8, 6]\ncamera_model: pinhole\nintrinsics: [5, 5, 4, 3]\n"
      "distortion_model: radial-tangential\ndistortion_coefficients: [0, 0, 0, 0]\n";
  return {{{"mav0/cam0/data.csv", list},
           {"mav0/cam1/data.csv", list},
           {"mav0/cam0/sensor.yaml", sensor},
           {"mav0/state_groundtruth_estimate0/data.csv", "#t,p,q\n100,1,2,3,1,0,0,0\n"},
           {"mav0/cam1/sensor.yaml", sensor}},
          {"mav0/cam0/data/1.pgm"}};
}

}  // namespace plumbline

// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/io/scratch_folder.h"
#include <cstdint>
#include <string>
#include <vector>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

namespace plumbline {

// A PNG file of one grey value (8 bit), or of one depth value (16 bit) where value > 255.
inline std::string Png(int width, int height, int value) {
  const cv::Mat image(height, width, value > 255 ? CV_16UC1 : CV_8UC1, cv::Scalar(value));
  std::vector<std::uint8_t> bytes;
  cv::imencode(".png", image, bytes);
  return {bytes.begin(), bytes.end()};
}

inline std::string EurocSensorYaml(double x, double y) {
  return "T_BS:\n  cols: 4\n  rows: 4\n  data: [1,0,0," + std::to_string(x) + ", 0,1,0," +
         std::to_string(y) +
         ", 0,0,1,0, 0,0,0,1]\n"
         "rate_hz: 20\nresolution: [8, 6]\ncamera_model: pinhole\nintrinsics: [5, 5, 4, 3]\n"
         "distortion_model: radial-tangential\ndistortion_coefficients: [0, 0, 0, 0]\n";
}

// Three stereo pairs of 8x6 pixels at 100, 200, 300 ns; left images of value 1, 2, 3, right images
// of 11, 12, 13. The cameras sit at x = 0.5 and 0.6 m of the body.
inline void WriteEuroc(const ScratchFolder& folder) {
  for (const int camera : {0, 1}) {
    const std::string name = "mav0/cam" + std::to_string(camera);
    folder.Write(name + "/sensor.yaml", EurocSensorYaml(camera == 0 ? 0.5 : 0.6, 0));
    folder.Write(name + "/data.csv",
                 "#timestamp [ns],filename\r\n100,1.png\r\n200,2.png\r\n"
                 "300,3.png\r\n");
    for (const int i : {1, 2, 3}) {
      folder.Write(name + "/data/" + std::to_string(i) + ".png", Png(8, 6, i + 10 * camera));
    }
  }
  folder.Write("mav0/state_groundtruth_estimate0/data.csv",
               "#timestamp,px,py,pz,qw,qx,qy,qz\n"
               "100,1,2,3,0.70710678118654757,0,0,0.70710678118654757\n"
               "200,1,2,3,1,0,0,0\n");
}

// Three stereo pairs of 8x6 pixels, values as above.
inline void WriteKitti(const ScratchFolder& folder) {
  folder.Write("times.txt", "0.000000e+00\n1.037000e-01\n2.074000e-01\n");
  folder.Write("calib.txt",
               "P0: 700 0 4 0 0 710 3 0 0 0 1 0\nP1: 700 0 4 -380 0 710 3 0 0 0 1 0\n");
  folder.Write("poses.txt",
               "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 0 0 1 0 0 0 0 1 1\n1 0 0 0 0 1 0 0 0 0 1 2\n");
  for (const int i : {0, 1, 2}) {
    const std::string name = "/00000" + std::to_string(i) + ".png";
    folder.Write("image_0" + name, Png(8, 6, i + 1));
    folder.Write("image_1" + name, Png(8, 6, i + 11));
  }
}

// Four colour images of values 1 to 4, three depth images of 1, 2 and 3 m.
inline void WriteTumFolder(const ScratchFolder& folder) {
  folder.Write("rgb.txt",
               "# color images\n1.000 rgb/1.png\n1.033 rgb/2.png\n1.100 rgb/3.png\n"
               "1.200 rgb/4.png\n");
  folder.Write("depth.txt", "# depth\n1.010 depth/1.png\n1.081 depth/2.png\n1.221 depth/3.png\n");
  folder.Write("groundtruth.txt", "# truth\n1.0 0 0 0 0 0 0 1\n");
  folder.Write("camera.yaml", "size: [8, 6]\nintrinsics: [5, 5, 4, 3]\ndepth_factor: 1000\n");
  for (const int i : {1, 2, 3, 4}) {
    folder.Write("rgb/" + std::to_string(i) + ".png", Png(8, 6, i));
    if (i < 4) folder.Write("depth/" + std::to_string(i) + ".png", Png(8, 6, 1000 * i));
  }
}

}  // namespace plumbline

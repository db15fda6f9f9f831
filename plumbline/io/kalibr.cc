// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/kalibr.h"

#include "plumbline/io/camera_section.h"

namespace plumbline {
namespace {

Camera ReadCamera(const YamlSection& section) {
  return ReadModelCamera(section, {"resolution", "intrinsics", "distortion_coeffs"}, "radtan");
}

}  // namespace

Calibration ReadKalibr(const YamlSection& root) {
  Calibration calibration;
  calibration.left = ReadCamera(root.Child("cam0"));
  if (root.Has("cam1")) {
    const YamlSection right = root.Child("cam1");
    calibration.right = ReadCamera(right);
    calibration.right_from_left = right.Motion("T_cn_cnm1");
  }
  return calibration;
}

}  // namespace plumbline

// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/kalibr.h"

#include "plumbline/io/camera_section.h"

#include <optional>
#include <string>

namespace plumbline {
namespace {

Camera ReadCamera(const YamlSection& section) {
  return ReadModelCamera(section, {"resolution", "intrinsics", "distortion_coeffs"}, "radtan");
}

// What Kalibr does not know stands at the top of the file, or with the left camera.
std::optional<double> AddedNumber(const YamlSection& root, const std::string& key) {
  const YamlSection left = root.Child("cam0");
  if (!root.Has(key)) return left.Has(key) ? std::optional(left.Positive(key)) : std::nullopt;
  if (left.Has(key)) root.Fail(key, "expected it here or in cam0, found both");
  return root.Positive(key);
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
  calibration.rate_hz = AddedNumber(root, "rate_hz");
  calibration.depth_factor = AddedNumber(root, "depth_factor");
  return calibration;
}

}  // namespace plumbline

// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/camera.h"
#include "plumbline/geometry/se3.h"
#include "plumbline/io/yaml_section.h"

#include <filesystem>

namespace plumbline {

// Contents of a EuRoC sensor.yaml of one camera.
struct EurocSensor {
  Camera camera;
  Rigid3 body_from_camera;  // T_BS
  double rate_hz = 0;
};

// Throws InputError "path:line: key: expected ..., found ...".
EurocSensor ReadEurocSensor(const std::filesystem::path& path);
EurocSensor ReadEurocSensor(const YamlSection& root);

}  // namespace plumbline

// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace plumbline {

// A file of configs/cameras, compiled into the program so that it needs no installed files.
struct BuiltInCamera {
  std::string name;  // without .yaml
  std::string yaml;
};

// In the order of the names.
const std::vector<BuiltInCamera>& BuiltInCameraFiles();

}  // namespace plumbline

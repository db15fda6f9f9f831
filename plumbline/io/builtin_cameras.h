// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace plumbline {

// A file of configs/cameras, compiled into the program so that it needs no installed files.
struct BuiltInCamera {
  std::string name;  // name of the file without .yaml
  std::string yaml;
};

// Returns the files in the order of their names.
const std::vector<BuiltInCamera>& BuiltInCameraFiles();

}  // namespace plumbline

// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/error.h"
#include "plumbline/io/cameras/camera_file.h"

#include "fuzz/input_folder.h"
#include <string>

// Camera files of all formats; what was read can be written and read again.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace plumbline;
  try {
    const Calibration calibration = ParseCamera(std::string(AsText(data, size)), "input");
    (void)ParseCamera(FormatCamera(calibration), "written");
  } catch (const InputError& error) {
    if (std::string_view(error.what()).starts_with("written")) throw BugError(error.what());
  }
  return 0;
}

// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/error.h"
#include "plumbline/inertial/inertial_check.h"
#include "plumbline/io/inertial/inertial_calibration_file.h"
#include "plumbline/io/inertial/inertial_recording.h"

#include "fuzz/input_folder.h"
#include <string>

// Rows of samples, and calibrations of sensors; a calibration that was read can be written and read
// again.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace plumbline;
  static const InputFolder folder;
  const std::string_view text = AsText(data, size);
  try {
    const auto recording = OpenInertialAlone(folder.Write("imu.csv", text), {});
    (void)InertialFaults(CheckInertial(recording.ordered, {}), {});
  } catch (const InputError&) {
  }
  try {
    const auto root = YamlSection::Parse(std::string(text), "input");
    const auto read = ParseInertialCalibration(root, Rigid3{});
    if (!read) return 0;
    const std::string written = FormatInertialCalibration(*read);
    if (written == "imu:\n") return 0;  // a file that tells no number
    (void)ParseInertialCalibration(YamlSection::Parse(written, "written"), {});
  } catch (const InputError& error) {
    if (std::string_view(error.what()).starts_with("written")) throw BugError(error.what());
  }
  return 0;
}

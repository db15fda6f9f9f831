// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/recording/mcap_file_writer.h"
#include "plumbline/view/view_state.h"

#include <filesystem>

namespace plumbline {

// Writes what viewers are sent into an MCAP file: the same channels, of every frame, with the
// stamps of the sensor.
class ViewRecorder {
 public:
  // InputError where the file cannot be written; so throw all functions.
  explicit ViewRecorder(const std::filesystem::path& path);

  // What is new since the last time. After each frame.
  void Record(ViewState& state);
  void Close() { file_.Close(); }

 private:
  McapFileWriter file_;
  ViewCursor cursor_;
};

}  // namespace plumbline

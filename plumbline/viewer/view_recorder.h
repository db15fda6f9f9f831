// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/recording/mcap_file_writer.h"
#include "plumbline/viewer/view_state.h"

#include <filesystem>

namespace plumbline {

// Writes what viewers are sent into an MCAP file: the same channels, for every frame, with the
// stamps of the sensor.
class ViewRecorder {
 public:
  // Begins a file. Throws InputError where it cannot be written, as do all functions.
  explicit ViewRecorder(const std::filesystem::path& path);

  // Writes what is new since the last call. To be called after each frame.
  void Record(ViewState& state);
  void Close() { file_.Close(); }

 private:
  McapFileWriter file_;
  ViewCursor cursor_;
};

}  // namespace plumbline

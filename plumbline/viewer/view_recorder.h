// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/recording/mcap_file_writer.h"
#include "plumbline/viewer/view_state.h"

#include <filesystem>

namespace plumbline {

// Records the messages of viewers in an MCAP file: the same channels, for every frame, with the
// stamps of the sensor.
class ViewRecorder {
 public:
  // Creates the file. Throws InputError if it cannot be written, as do all functions.
  explicit ViewRecorder(const std::filesystem::path& path);

  // Writes the messages new since the last call. Call it after each frame.
  void Record(ViewState& state);
  void Close() { file_.Close(); }

 private:
  McapFileWriter file_;
  ViewCursor cursor_;
};

}  // namespace plumbline

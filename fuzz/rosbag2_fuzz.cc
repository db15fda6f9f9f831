// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/datasets/rosbag2_files.h"
#include "plumbline/io/recordings/compression.h"
#include "plumbline/io/recordings/recording_formats.h"

#include "fuzz/recording_fuzz.h"
#include <span>

// Files of ROS 2's recorder: .db3 (also packed), or the metadata of a folder.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace plumbline;
  const std::span<const std::uint8_t> bytes(data, size);
  const std::string_view text = AsText(data, size);
  if (BeginsAsSqlite(bytes)) {
    OpenInvented(text, "x.db3", DatasetFormat::kRosbag2);
  } else if (IsZstd(bytes)) {
    OpenInvented(text, "x.db3.zstd", DatasetFormat::kRosbag2);
  } else {
    static const InputFolder folder;
    folder.Write("x_0.db3", "");
    folder.Write("metadata.yaml", text);
    try {
      (void)FindRosbag2Files(folder.path());
    } catch (const InputError&) {
    }
  }
  return 0;
}

// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/error.h"
#include "plumbline/io/datasets/dataset.h"
#include "plumbline/io/datasets/open_dataset.h"
#include "plumbline/io/inertial/inertial_recording.h"

#include "fuzz/input_folder.h"
#include <algorithm>
#include <cstddef>
#include <string>

namespace plumbline {

// Opens an invented file of messages and reads its first frames, whether there is a calibration in
// it or not. Anything but an InputError that comes out is a fault.
inline void OpenInvented(std::string_view bytes, const char* name, DatasetFormat format) {
  static const InputFolder folder;
  const std::filesystem::path path = folder.Write(name, bytes);
  for (const bool camera_may_miss : {true, false}) {
    try {
      DatasetOptions options;
      options.format = format;
      options.allow_missing_camera = camera_may_miss;
      const auto dataset = OpenDataset(path, options);
      constexpr std::size_t kMost = 4;
      for (std::size_t i = 0; i < std::min(dataset->size(), kMost); ++i) (void)dataset->Read(i);
    } catch (const InputError&) {
    }
  }
  try {
    (void)FindInertial(path, format, {});
  } catch (const InputError&) {
  }
}

}  // namespace plumbline

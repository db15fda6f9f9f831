// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/io/datasets/image_file.h"
#include "plumbline/io/text_rows.h"

#include "tests/io/scratch_folder.h"
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <utility>

namespace plumbline {

// An image of a EuRoC folder, as others send it: its pixels, or, where it cannot be decoded, the
// bytes of its file.
struct EurocImage {
  int camera = 0;
  std::int64_t stamp_ns = 0;
  bool readable = true;
  int width = 0, height = 0;
  std::string bytes;
};

// The frames from `first` to before `end` of a EuRoC folder, left and right image in turn.
inline void ForEachEurocImage(const std::filesystem::path& sequence,
                              std::pair<std::size_t, std::size_t> frames,
                              const std::function<void(const EurocImage&)>& take) {
  const auto folder = [&](int camera) {
    return sequence / "mav0" / ("cam" + std::to_string(camera));
  };
  const auto left = ReadRows(folder(0) / "data.csv", ',');
  const auto right = ReadRows(folder(1) / "data.csv", ',');
  for (std::size_t i = frames.first; i < frames.second; ++i) {
    for (const int camera : {0, 1}) {
      const TextRow& row = (camera == 0 ? left : right).at(i);
      const std::filesystem::path file = folder(camera) / "data" / std::string(row.fields[1]);
      EurocImage image{camera, std::stoll(std::string(row.fields[0])), true, 0, 0, ""};
      const auto pixels = ReadGrayImage(file);
      image.readable = static_cast<bool>(pixels);
      if (pixels) {
        image.width = pixels->width();
        image.height = pixels->height();
        image.bytes.assign(
            reinterpret_cast<const char*>(pixels->data()),
            static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
      } else {
        image.bytes = Contents(file);
      }
      take(image);
    }
  }
}

}  // namespace plumbline

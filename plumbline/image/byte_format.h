// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/byte_format.h"
#include "plumbline/image/image.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace plumbline {

// Transfer (base/byte_format.h) of images: width, height, pixels row by row.
template <class Archive, Like<GrayImage> T>
void Transfer(Archive& archive, T& image) {
  auto width = static_cast<std::int32_t>(image.width());
  auto height = static_cast<std::int32_t>(image.height());
  TransferAll(archive, width, height);
  const auto count = static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
  if constexpr (Archive::kReading) {
    if (width < 0 || height < 0 || count > archive.remaining()) {
      throw InputError(archive.source() + ": ends early");
    }
    const auto pixels = archive.Take(static_cast<std::size_t>(count));
    image = GrayImage(width, height);
    std::copy(pixels.begin(), pixels.end(), image.data());
  } else {
    const auto pixels = archive.Append(static_cast<std::size_t>(count));
    std::copy_n(image.data(), pixels.size(), pixels.begin());
  }
}

}  // namespace plumbline

// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/error.h"
#include "plumbline/io/datasets/image_file.h"

#include <cstddef>
#include <cstdint>
#include <span>

// What is found out of image files before a decoder sees them: their structure and size.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace plumbline;
  const std::span<const std::uint8_t> bytes(data, size);
  (void)FindDamage(bytes);
  if (const auto image = SizeInHeader(bytes)) {
    PLUMBLINE_CHECK(image->width > 0 && image->height > 0, "an image has pixels");
  }
  return 0;
}

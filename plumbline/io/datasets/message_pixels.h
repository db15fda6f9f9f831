// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/io/datasets/image_file.h"
#include "plumbline/io/datasets/raw_pixels.h"
#include "plumbline/io/recordings/image_message.h"

#include <filesystem>
#include <optional>
#include <string_view>

namespace plumbline {

// Returns the pixels of a message that is not compressed.
RawPixels PixelsOf(const ImageMessage& image);

// Returns true for the encoding of depth in metres, packed or not.
bool IsInMetres(std::string_view encoding);

// Decodes the image of a message, compressed or not. Failures, which have `name`, are those of
// DecodeGrayImage and GrayOfPixels; `bits` is theirs, too.
Expected<GrayImage, ImageFailure> GrayOfMessage(const std::filesystem::path& name,
                                                const ImageMessage& image,
                                                std::optional<ImageSize> wanted,
                                                std::optional<int> bits = std::nullopt);

// Decodes the mask of a message as DecodeMask: 0 where all channels are, 255 elsewhere.
Expected<GrayImage, ImageFailure> MaskOfMessage(const std::filesystem::path& name,
                                                const ImageMessage& image,
                                                std::optional<ImageSize> wanted);

// Decodes the depth of a message to metres: 16 bits as value / factor, 32FC1 as it is, and both
// packed by image_transport's compressedDepth. Failures are those of DecodeDepthImage and
// DepthOfPixels.
Expected<DepthImage, ImageFailure> DepthOfMessage(const std::filesystem::path& name,
                                                  const ImageMessage& image,
                                                  double factor,
                                                  std::optional<ImageSize> wanted);

}  // namespace plumbline

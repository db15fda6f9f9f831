// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include <opencv2/core.hpp>

namespace plumbline {

// Codecs of PNG, JPEG and WebP by libspng, TurboJPEG and libwebp, which are small: OpenCV's own
// codecs bring a hundred libraries along (opencv_modules.h). Matrices are as OpenCV's codecs give
// and take them: CV_8UC1, CV_8UC3 (blue, green, red) or CV_16UC1 (PNG alone).

// Decodes grey images of up to 16 bits and colours of 8 bits; alpha is left out. Returns an empty
// matrix for other kinds of PNG files, and for bytes that libspng refuses.
cv::Mat DecodePng(std::span<const std::uint8_t> bytes);

// Decodes grey images and colours; an orientation in the file is ignored. Returns an empty matrix
// for other kinds of JPEG files (CMYK), and for bytes that TurboJPEG refuses; where it only warns
// there is an image.
cv::Mat DecodeJpeg(std::span<const std::uint8_t> bytes);

// Decodes to colours, even grey images, since WebP knows nothing else; alpha is left out. Returns
// an empty matrix for animations and for bytes that libwebp refuses.
cv::Mat DecodeWebp(std::span<const std::uint8_t> bytes);

// Returns the bytes of a file, compressed for speed rather than size.
std::string EncodePng(const cv::Mat& image);

// Most pixels that a side of a JPEG file may have.
inline constexpr int kLongestJpegSide = 65'500;

// Returns the bytes of a file. quality: 1 to 100. For CV_8UC1, of sides up to kLongestJpegSide.
std::string EncodeJpeg(const cv::Mat& image, int quality);

}  // namespace plumbline

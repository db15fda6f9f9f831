// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include <opencv2/core.hpp>

namespace plumbline {

// Codecs of PNG, JPEG and WebP by libdeflate, libspng, TurboJPEG and libwebp, which are small:
// OpenCV's own codecs bring a hundred libraries along (opencv_modules.h). Matrix types as of
// OpenCV's codecs: CV_8UC1, CV_8UC3 (blue, green, red) or CV_16UC1 (PNG only).

// Decodes grey images of up to 16 bits and colours of 8 bits; drops alpha. Returns an empty matrix
// for other kinds of PNG files, and for bytes that libspng refuses. What DecodePlainPng
// (plain_png.h) decodes does not come to libspng.
cv::Mat DecodePng(std::span<const std::uint8_t> bytes);

// Decodes grey images and colours; ignores the orientation in the file. Returns an empty matrix for
// other kinds of JPEG files (CMYK), and for bytes that TurboJPEG refuses; after a mere warning it
// returns the image.
cv::Mat DecodeJpeg(std::span<const std::uint8_t> bytes);

// Decodes to colours, even grey images, since WebP has no grey; drops alpha. Returns an empty
// matrix for animations and for bytes that libwebp refuses.
cv::Mat DecodeWebp(std::span<const std::uint8_t> bytes);

// Returns the bytes of a file, compressed for speed rather than size.
std::string EncodePng(const cv::Mat& image);

// Largest width or height of a JPEG file.
inline constexpr int kLongestJpegSide = 65'500;

// Returns the bytes of a file. quality: 1 to 100. For CV_8UC1, of sides up to kLongestJpegSide.
std::string EncodeJpeg(const cv::Mat& image, int quality);

}  // namespace plumbline

// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/image/image_codecs.h"

#include "plumbline/base/error.h"
#include "plumbline/image/plain_png.h"

#include <cstddef>
#include <cstdlib>
#include <memory>

#include <opencv2/imgproc.hpp>
#include <spng.h>
#include <turbojpeg.h>
#include <webp/decode.h>

namespace plumbline {
namespace {

struct FreeSpng {
  void operator()(spng_ctx* context) const { spng_ctx_free(context); }
};
using Spng = std::unique_ptr<spng_ctx, FreeSpng>;

struct DestroyTurboJpeg {
  void operator()(void* handle) const { tjDestroy(handle); }
};
using TurboJpeg = std::unique_ptr<void, DestroyTurboJpeg>;

// The format in which libspng is asked for an image, and the type of the matrix that receives it.
struct PngPixels {
  int format = 0;
  int type = 0;  // type of the matrix
};

// Returns the format for a kind of image; type -1 if that kind is not decoded here.
PngPixels PixelsOf(const spng_ihdr& header) {
  const bool grey = header.color_type == SPNG_COLOR_TYPE_GRAYSCALE;
  const bool color = header.color_type == SPNG_COLOR_TYPE_TRUECOLOR ||
                     header.color_type == SPNG_COLOR_TYPE_TRUECOLOR_ALPHA;
  if (grey && header.bit_depth == 16) return {SPNG_FMT_PNG, CV_16UC1};
  if (grey) return {SPNG_FMT_G8, CV_8UC1};
  if (color && header.bit_depth == 8) return {SPNG_FMT_RGB8, CV_8UC3};
  return {0, -1};
}

std::size_t SizeOf(const cv::Mat& image) { return image.total() * image.elemSize(); }

}  // namespace

cv::Mat DecodePng(std::span<const std::uint8_t> bytes) {
  if (cv::Mat image = DecodePlainPng(bytes); !image.empty()) return image;
  const Spng context(spng_ctx_new(0));
  PLUMBLINE_CHECK(context != nullptr, "memory for a decoder");
  spng_ihdr header{};
  if (spng_set_png_buffer(context.get(), bytes.data(), bytes.size()) != 0 ||
      spng_get_ihdr(context.get(), &header) != 0) {
    return {};
  }
  const PngPixels pixels = PixelsOf(header);
  std::size_t size = 0;
  if (pixels.type < 0 || spng_decoded_image_size(context.get(), pixels.format, &size) != 0) {
    return {};
  }
  cv::Mat image(static_cast<int>(header.height), static_cast<int>(header.width), pixels.type);
  if (size != SizeOf(image) ||
      spng_decode_image(context.get(), image.data, size, pixels.format, 0) != 0) {
    return {};
  }
  if (pixels.type == CV_8UC3) cv::cvtColor(image, image, cv::COLOR_RGB2BGR);
  return image;
}

cv::Mat DecodeJpeg(std::span<const std::uint8_t> bytes) {
  const TurboJpeg decoder(tjInitDecompress());
  PLUMBLINE_CHECK(decoder != nullptr, "memory for a decoder");
  const auto size = static_cast<unsigned long>(bytes.size());
  int width = 0, height = 0, sampling = 0, color_space = 0;
  if (tjDecompressHeader3(
          decoder.get(), bytes.data(), size, &width, &height, &sampling, &color_space) != 0 ||
      color_space == TJCS_CMYK || color_space == TJCS_YCCK) {
    return {};
  }
  const bool grey = color_space == TJCS_GRAY;
  cv::Mat image(height, width, grey ? CV_8UC1 : CV_8UC3);
  const int result = tjDecompress2(decoder.get(),
                                   bytes.data(),
                                   size,
                                   image.data,
                                   width,
                                   static_cast<int>(image.step),
                                   height,
                                   grey ? TJPF_GRAY : TJPF_BGR,
                                   0);
  if (result != 0 && tjGetErrorCode(decoder.get()) != TJERR_WARNING) return {};
  return image;
}

cv::Mat DecodeWebp(std::span<const std::uint8_t> bytes) {
  WebPBitstreamFeatures features{};
  if (WebPGetFeatures(bytes.data(), bytes.size(), &features) != VP8_STATUS_OK ||
      features.has_animation != 0) {
    return {};
  }
  cv::Mat image(features.height, features.width, CV_8UC3);
  const std::uint8_t* decoded = WebPDecodeBGRInto(
      bytes.data(), bytes.size(), image.data, SizeOf(image), static_cast<int>(image.step));
  return decoded == nullptr ? cv::Mat() : image;
}

std::string EncodePng(const cv::Mat& image) {
  PLUMBLINE_CHECK(image.type() == CV_8UC1 || image.type() == CV_8UC3 || image.type() == CV_16UC1,
                  "a kind of image that can be encoded");
  cv::Mat pixels;
  if (image.type() == CV_8UC3) {
    cv::cvtColor(image, pixels, cv::COLOR_BGR2RGB);
  } else {
    pixels = image.isContinuous() ? image : image.clone();
  }
  const Spng context(spng_ctx_new(SPNG_CTX_ENCODER));
  PLUMBLINE_CHECK(context != nullptr, "memory for an encoder");
  spng_ihdr header{};
  header.width = static_cast<std::uint32_t>(pixels.cols);
  header.height = static_cast<std::uint32_t>(pixels.rows);
  header.bit_depth = image.type() == CV_16UC1 ? 16 : 8;
  header.color_type =
      image.type() == CV_8UC3 ? SPNG_COLOR_TYPE_TRUECOLOR : SPNG_COLOR_TYPE_GRAYSCALE;
  constexpr int kFastest = 1, kRunLengths = 3;  // zlib's Z_BEST_SPEED and Z_RLE
  spng_set_option(context.get(), SPNG_ENCODE_TO_BUFFER, 1);
  spng_set_option(context.get(), SPNG_IMG_COMPRESSION_LEVEL, kFastest);
  spng_set_option(context.get(), SPNG_IMG_COMPRESSION_STRATEGY, kRunLengths);
  spng_set_option(context.get(), SPNG_FILTER_CHOICE, SPNG_FILTER_CHOICE_SUB);
  int error = spng_set_ihdr(context.get(), &header);
  if (error == 0) {
    error = spng_encode_image(
        context.get(), pixels.data, SizeOf(pixels), SPNG_FMT_PNG, SPNG_ENCODE_FINALIZE);
  }
  std::size_t size = 0;
  const std::unique_ptr<void, decltype(&std::free)> bytes(
      error == 0 ? spng_get_png_buffer(context.get(), &size, &error) : nullptr, &std::free);
  PLUMBLINE_CHECK(error == 0 && bytes != nullptr, spng_strerror(error));
  return {static_cast<const char*>(bytes.get()), size};
}

std::string EncodeJpeg(const cv::Mat& image, int quality) {
  PLUMBLINE_CHECK(image.type() == CV_8UC1 && !image.empty(), "a grey image");
  const TurboJpeg encoder(tjInitCompress());
  PLUMBLINE_CHECK(encoder != nullptr, "memory for an encoder");
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  const int result = tjCompress2(encoder.get(),
                                 image.data,
                                 image.cols,
                                 static_cast<int>(image.step),
                                 image.rows,
                                 TJPF_GRAY,
                                 &bytes,
                                 &size,
                                 TJSAMP_GRAY,
                                 quality,
                                 TJFLAG_ACCURATEDCT);
  const std::unique_ptr<unsigned char, decltype(&tjFree)> owned(bytes, &tjFree);
  PLUMBLINE_CHECK(result == 0, "a grey image can be encoded");
  return {reinterpret_cast<const char*>(bytes), size};
}

}  // namespace plumbline

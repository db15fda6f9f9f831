// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "sensor_messages.h"

#include "plumbline/base/error.h"
#include "plumbline/io/datasets/raw_pixels.h"
#include "plumbline/io/datasets/recorded_calibration.h"

#include <span>

namespace plumbline::ros_node {
namespace {

RawPixels PixelsOf(const RawImage& image, ImageContents contents) {
  if (ContentsOfEncoding(image.encoding) != contents) {
    throw InputError(image.topic + ": expected an image of " +
                     (contents == ImageContents::kGray ? "grey levels or colours" : "depth") +
                     ", found the encoding '" + image.encoding + "'");
  }
  return {image.encoding,
          image.width,
          image.height,
          image.step,
          image.big_endian,
          std::span(image.data, image.size)};
}

template <class T>
T OrThrow(const Expected<T, ImageFailure>& image) {
  if (image) return *image;
  throw InputError(image.error().path.string() + ": " + image.error().why);
}

RecordedCamera CameraOf(const CameraNumbers& camera, bool rectified) {
  CalibrationMessage message;
  message.width = camera.width;
  message.height = camera.height;
  message.distortion_model = camera.distortion_model;
  message.d = camera.d;
  message.k = camera.k;
  message.r = camera.r;
  message.p = camera.p;
  message.binning_x = camera.binning_x;
  message.binning_y = camera.binning_y;
  message.roi_x = camera.region[0];
  message.roi_y = camera.region[1];
  message.roi_width = camera.region[2];
  message.roi_height = camera.region[3];
  if (!IsCalibrated(message)) {
    throw InputError(camera.topic +
                     ": expected the numbers of a camera, found zeros; give a camera file");
  }
  return {message, camera.topic, rectified};
}

}  // namespace

GrayImage GrayOf(const RawImage& image, const ImageSize& wanted) {
  return OrThrow(GrayOfPixels(image.topic, PixelsOf(image, ImageContents::kGray), wanted));
}

DepthImage DepthOf(const RawImage& image, const ImageSize& wanted) {
  return OrThrow(
      DepthOfPixels(image.topic, PixelsOf(image, ImageContents::kDepth), kDepthFactor, wanted));
}

Calibration CalibrationOf(const CameraNumbers& left,
                          const std::optional<CameraNumbers>& right,
                          bool rectified,
                          bool with_depth) {
  std::optional<RecordedCamera> second;
  if (right) second = CameraOf(*right, rectified);
  Calibration calibration = plumbline::CalibrationOf(CameraOf(left, rectified), second);
  if (with_depth) calibration.depth_factor = kDepthFactor;
  return calibration;
}

}  // namespace plumbline::ros_node

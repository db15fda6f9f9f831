// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "sensor_messages.h"

#include "plumbline/base/error.h"
#include "plumbline/base/printable.h"
#include "plumbline/io/datasets/message_pixels.h"
#include "plumbline/io/datasets/raw_pixels.h"
#include "plumbline/io/datasets/recorded_calibration.h"

namespace plumbline::ros_node {
namespace {

void CheckContents(const TopicImage& image, ImageContents contents) {
  const ImageMessage& message = image.message;
  if (message.compressed || ContentsOfEncoding(message.encoding) == contents) return;
  throw InputError(image.topic + ": expected an image of " +
                   (contents == ImageContents::kGray ? "grey levels or colours" : "depth") +
                   ", found the encoding " + InQuotes(message.encoding));
}

template <class T>
T OrThrow(const Expected<T, ImageFailure>& image) {
  if (image) return *image;
  throw InputError(image.error().path.string() + ": " + image.error().why);
}

RecordedCamera CameraOf(const TopicCamera& camera, bool rectified) {
  if (!IsCalibrated(camera.message)) {
    throw InputError(camera.topic +
                     ": expected the numbers of a camera, found zeros; give a camera file");
  }
  return {camera.message, camera.topic, rectified};
}

}  // namespace

GrayImage GrayOf(const TopicImage& image, const ImageSize& wanted) {
  CheckContents(image, ImageContents::kGray);
  return OrThrow(GrayOfMessage(image.topic, image.message, wanted));
}

DepthImage DepthOf(const TopicImage& image, const ImageSize& wanted) {
  CheckContents(image, ImageContents::kDepth);
  return OrThrow(DepthOfMessage(image.topic, image.message, kDepthFactor, wanted));
}

Calibration CalibrationOf(const TopicCamera& left,
                          const std::optional<TopicCamera>& right,
                          bool rectified,
                          bool with_depth) {
  std::optional<RecordedCamera> second;
  if (right) second = CameraOf(*right, rectified);
  Calibration calibration = plumbline::CalibrationOf(CameraOf(left, rectified), second);
  if (with_depth) calibration.depth_factor = kDepthFactor;
  return calibration;
}

}  // namespace plumbline::ros_node

// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/foxglove/messages.h"
#include "plumbline/slam/system.h"

#include <array>
#include <string>
#include <string_view>

namespace plumbline {

// A frame for display.
struct ViewedFrame {
  FrameRecord record;
  GrayImage image;  // rectified left; may be missing
  GrayImage right;  // rectified right; empty unless the camera is a pair
  std::shared_ptr<const FrameFeatures> indexed;
  std::vector<PointId> points;  // landmark of each feature, an invalid id for none
  std::vector<LineId> lines;
  Rigid3 world_from_camera;  // rectified left camera, if tracked

  bool is_tracked() const { return record.status == FrameStatus::kTracked; }
  std::int64_t stamp_ns() const { return record.stamp_ns; }
};

// Copies the displayed parts, mostly the image: 0.1 ms.
ViewedFrame ViewedFrameOf(const FrameRecord& record, const FrameView& view);
// Returns a keyframe of a saved map, which has no image.
ViewedFrame ViewedFrameOf(const KeyFrame& keyframe);

// Returns the image as a JPEG file, some 2 ms for 752 x 480; empty if the image is empty or has a
// side longer than kLongestJpegSide.
std::string JpegOf(const GrayImage& image);

// Returns matched points, other points, matched lines and other lines, in the colours of the
// report.
std::array<ImageMarks, 4> MarksOf(const ViewedFrame& frame);

// Returns plumbline.Frame. `jpeg` goes into its field `image` unless it is empty.
ProtobufWriter FrameMessage(const ViewedFrame& frame, std::string_view jpeg = {});

}  // namespace plumbline

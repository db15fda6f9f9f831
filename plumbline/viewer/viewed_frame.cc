// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/viewer/viewed_frame.h"

#include "plumbline/base/options.h"
#include "plumbline/image/image_codecs.h"
#include "plumbline/image/opencv_bridge.h"
#include "plumbline/slam/load_control.h"

#include <algorithm>
#include <limits>

namespace plumbline {
namespace {

constexpr int kJpegQuality = 85;
// The number for a feature that shows no landmark.
constexpr std::int32_t kNothing = -1;
// The number for a landmark that mapping has not made yet.
constexpr std::int32_t kNotYetInMap = -2;

template <class Tag>
std::int32_t NumberOf(Id<Tag> id) {
  if (!id.valid()) return kNothing;
  if (id.value > std::numeric_limits<std::int32_t>::max()) return kNotYetInMap;
  return static_cast<std::int32_t>(id.value);
}

std::uint64_t Unsigned(int count) { return count > 0 ? static_cast<std::uint64_t>(count) : 0; }

void AddFeatures(const ViewedFrame& frame, ProtobufWriter& message) {
  if (frame.indexed == nullptr) return;
  const Features features = MeasuredFeatures(*frame.indexed);
  std::vector<float> numbers;
  std::vector<std::int32_t> ids;
  const auto put = [&](const Eigen::Vector2d& px) {
    numbers.push_back(static_cast<float>(px.x()));
    numbers.push_back(static_cast<float>(px.y()));
  };
  for (std::size_t i = 0; i < features.points.size(); ++i) {
    put(features.points[i].px);
    ids.push_back(i < frame.points.size() ? NumberOf(frame.points[i]) : kNothing);
  }
  message.Packed<float>(11, numbers).Packed<std::int32_t>(12, ids);
  numbers.clear();
  ids.clear();
  for (std::size_t i = 0; i < features.lines.size(); ++i) {
    put(features.lines[i].segment.start);
    put(features.lines[i].segment.end);
    ids.push_back(i < frame.lines.size() ? NumberOf(frame.lines[i]) : kNothing);
  }
  message.Packed<float>(13, numbers).Packed<std::int32_t>(14, ids);
}

}  // namespace

ViewedFrame ViewedFrameOf(const FrameRecord& record, const FrameView& view) {
  ViewedFrame frame;
  frame.record = record;
  frame.image = view.images.left;
  if (view.images.right) frame.right = *view.images.right;
  frame.indexed = view.frame.indexed;
  frame.points = view.frame.points;
  frame.lines = view.frame.lines;
  frame.world_from_camera = Inverse(view.frame.cam_from_world);
  return frame;
}

ViewedFrame ViewedFrameOf(const KeyFrame& keyframe) {
  ViewedFrame frame;
  frame.record.id = keyframe.frame.id;
  frame.record.stamp_ns = keyframe.frame.stamp_ns;
  frame.record.status = FrameStatus::kTracked;
  frame.record.keyframe = true;
  frame.indexed = keyframe.frame.indexed;
  frame.points = keyframe.frame.points;
  frame.lines = keyframe.frame.lines;
  frame.world_from_camera = Inverse(keyframe.frame.cam_from_world);
  return frame;
}

std::string JpegOf(const GrayImage& image) {
  if (image.empty() || std::max(image.width(), image.height()) > kLongestJpegSide) return {};
  return EncodeJpeg(AsMat(image), kJpegQuality);
}

std::array<ImageMarks, 4> MarksOf(const ViewedFrame& frame) {
  std::array<ImageMarks, 4> marks;
  auto& [matched_points, other_points, matched_lines, other_lines] = marks;
  matched_points.color = {0, 0.9, 0, 1};
  matched_points.thickness = 4;
  other_points.color = {0.66, 0.66, 0.66, 1};
  other_points.thickness = 3;
  matched_lines.color = {1, 0.55, 0, 1};
  matched_lines.thickness = 2;
  other_lines.color = {0.36, 0.58, 1, 1};
  if (frame.indexed == nullptr) return marks;
  const Features features = MeasuredFeatures(*frame.indexed);
  for (std::size_t i = 0; i < features.points.size(); ++i) {
    const bool matched = i < frame.points.size() && frame.points[i].valid();
    (matched ? matched_points : other_points).points.push_back(features.points[i].px);
  }
  for (std::size_t i = 0; i < features.lines.size(); ++i) {
    const bool matched = i < frame.lines.size() && frame.lines[i].valid();
    (matched ? matched_lines : other_lines).segments.push_back(features.lines[i].segment);
  }
  return marks;
}

ProtobufWriter FrameMessage(const ViewedFrame& frame, std::string_view jpeg) {
  const FrameRecord& record = frame.record;
  ProtobufWriter message;
  message.Varint(1, static_cast<std::uint64_t>(record.id.value))
      .Bytes(2, NameOf(record.status))
      .Bytes(3, record.reason);
  if (record.map.valid()) message.Varint(4, static_cast<std::uint64_t>(record.map.value));
  if (frame.is_tracked()) message.Message(5, PoseMessage(frame.world_from_camera));
  message.Varint(6, record.keyframe)
      .Varint(7, Unsigned(record.counts.inlier_points))
      .Varint(8, Unsigned(record.counts.inlier_lines));
  for (const StageTime& time : record.times) {
    message.Message(9, ProtobufWriter().Bytes(1, time.stage).Double(2, time.milliseconds));
  }
  if (record.shed != LoadLevel::kNothing) message.Bytes(10, NameOf(record.shed));
  AddFeatures(frame, message);
  if (!jpeg.empty()) message.Bytes(15, jpeg);
  return message;
}

}  // namespace plumbline

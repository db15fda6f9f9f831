// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/viewer/view_state.h"

#include "plumbline/base/error.h"
#include "plumbline/base/options.h"
#include "plumbline/image/image_codecs.h"
#include "plumbline/image/opencv_bridge.h"
#include "plumbline/slam/load_control.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace plumbline {
namespace {

std::size_t IndexOf(Stream stream) { return static_cast<std::size_t>(stream); }

std::uint64_t NumberOrZero(std::int64_t value) {
  return value > 0 ? static_cast<std::uint64_t>(value) : 0;
}

ProtobufWriter EventMessage(const ViewedEvent& event) {
  static constexpr std::array<std::string_view, 3> kNames = {"loop", "join", "relocalization"};
  ProtobufWriter message;
  message.Bytes(1, kNames[static_cast<std::size_t>(event.kind)])
      .Varint(2, NumberOrZero(event.frame.value))
      .Varint(3, NumberOrZero(event.keyframe.value))
      .Varint(4, NumberOrZero(event.older.value))
      .Varint(5, NumberOrZero(event.points))
      .Varint(6, NumberOrZero(event.lines))
      .Double(7, event.moved);
  return message;
}

SharedBytes Share(std::string bytes) {
  return std::make_shared<const std::string>(std::move(bytes));
}

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

void ViewState::Take(const ViewedCounts& counts) {
  if (counts == counts_) return;
  counts_ = counts;
  ++run_serial_;
}

void ViewState::Take(ViewedFrame frame) {
  shown_ = std::move(frame);
  ++serial_;
  jpeg_.reset();
  for (const Stream stream : {Stream::kImage,
                              Stream::kCalibration,
                              Stream::kAnnotations,
                              Stream::kPose,
                              Stream::kTransform,
                              Stream::kRightImage,
                              Stream::kRightCalibration}) {
    made_[IndexOf(stream)].reset();
  }
  if (shown_.record.keyframe && !shown_.image.empty()) KeepPicture();
}

void ViewState::SetPaused(bool paused) {
  paused_ = paused;
  ++run_serial_;
}

void ViewState::SetFinished() {
  finished_ = true;
  ++run_serial_;
}

const std::string& ViewState::Jpeg() {
  if (!jpeg_) jpeg_ = JpegOf(shown_.image);
  return *jpeg_;
}

void ViewState::KeepPicture() {
  const SharedBytes picture = Share(FrameMessage(shown_, Jpeg()).Take());
  picture_bytes_ += picture->size();
  pictures_[static_cast<std::uint32_t>(shown_.record.id.value)] = picture;
  while (picture_bytes_ > kKeptBytes && pictures_.size() > 1) {
    picture_bytes_ -= pictures_.begin()->second->size();
    pictures_.erase(pictures_.begin());
  }
}

SharedBytes ViewState::KeyFramePicture(ShownId id) const {
  const ShownKeyFrame* keyframe = map_.FindKeyFrame(id);
  if (keyframe == nullptr) return nullptr;
  const auto it = pictures_.find(keyframe->frame);
  return it == pictures_.end() ? nullptr : it->second;
}

SharedBytes ViewState::Next(Stream stream, ViewCursor& cursor, std::int64_t now_ns) {
  switch (stream) {
    case Stream::kPoints:
      return NextPoints(cursor, now_ns);
    case Stream::kLines:
      return NextLines(cursor);
    case Stream::kUpdates:
      return NextUpdate(cursor);
    default:
      return NextOfFrame(stream, cursor);
  }
}

SharedBytes ViewState::NextOfFrame(Stream stream, ViewCursor& cursor) {
  const std::size_t index = IndexOf(stream);
  if (cursor.frame[index] == serial_) return nullptr;
  cursor.frame[index] = serial_;
  const bool needs_pose = stream == Stream::kPose || stream == Stream::kTransform;
  if (needs_pose && !shown_.is_tracked()) return nullptr;
  const bool right = stream == Stream::kRightImage || stream == Stream::kRightCalibration;
  if (right && shown_.right.empty()) return nullptr;
  if (stream == Stream::kImage && Jpeg().empty()) return nullptr;
  if (!made_[index]) made_[index] = Share(EncodeOfFrame(stream));
  return made_[index]->empty() ? nullptr : made_[index];
}

std::string ViewState::EncodeOfFrame(Stream stream) {
  const std::int64_t stamp_ns = shown_.stamp_ns();
  switch (stream) {
    case Stream::kImage:
      return CompressedImageMessage(stamp_ns, "jpeg", Jpeg());
    case Stream::kCalibration:
      return CalibrationMessageOf(stamp_ns, run_.camera);
    case Stream::kRightImage: {
      const std::string jpeg = JpegOf(shown_.right);
      return jpeg.empty() ? jpeg : CompressedImageMessage(stamp_ns, "jpeg", jpeg);
    }
    case Stream::kRightCalibration:
      return CalibrationMessageOf(stamp_ns, run_.camera, CameraSide::kRight);
    case Stream::kAnnotations:
      return AnnotationsMessage(stamp_ns, MarksOf(shown_));
    case Stream::kPose:
      return PoseInFrameMessage(stamp_ns, shown_.world_from_camera);
    case Stream::kTransform:
      return TransformMessage(stamp_ns, shown_.world_from_camera);
    default:
      FailCheck("stream", "a stream of frames is wanted");
  }
}

SharedBytes ViewState::NextPoints(ViewCursor& cursor, std::int64_t now_ns) {
  if (cursor.points == map_.points_version()) return nullptr;
  const bool due =
      cursor.points == 0 || finished_ || now_ns - cursor.points_at_ns >= kBetweenCloudsNs;
  if (!due) return nullptr;
  cursor.points = map_.points_version();
  cursor.points_at_ns = now_ns;
  SharedBytes& made = made_[IndexOf(Stream::kPoints)];
  if (!made || points_made_ != cursor.points) {
    made = Share(PointCloudMessage(stamp_ns(), map_.PointCloud()));
    points_made_ = cursor.points;
  }
  return made;
}

SharedBytes ViewState::NextLines(ViewCursor& cursor) {
  if (cursor.lines == map_.lines_version()) return nullptr;
  const std::pair key(cursor.lines, map_.lines_version());
  SharedBytes& made = made_[IndexOf(Stream::kLines)];
  if (!made || lines_made_ != key) {
    const ViewedMap::Tiles tiles = map_.TilesSince(cursor.lines);
    made = Share(SceneUpdateMessage(stamp_ns(), tiles.entities, tiles.all));
    lines_made_ = key;
  }
  cursor.lines = map_.lines_version();
  return made;
}

ProtobufWriter ViewState::RunMessage() const {
  const RectifiedCamera& c = run_.camera;
  ProtobufWriter camera;
  camera.Varint(1, NumberOrZero(c.width)).Varint(2, NumberOrZero(c.height));
  camera.Double(3, c.fx).Double(4, c.fy).Double(5, c.cx).Double(6, c.cy);
  camera.Double(7, c.baseline);
  ProtobufWriter message;
  message.Bytes(1, run_.name)
      .Varint(2, counts_.frames)
      .Varint(3, run_.frames_expected.value_or(0))
      .Varint(4, counts_.dropped)
      .Varint(5, counts_.lost)
      .Double(6, counts_.per_second)
      .Varint(7, paused_)
      .Varint(8, run_.can_pause)
      .Varint(9, finished_)
      .Message(10, camera)
      .Varint(11, run_.saved_map);
  return message;
}

SharedBytes ViewState::NextUpdate(ViewCursor& cursor) {
  std::uint64_t& frame = cursor.frame[IndexOf(Stream::kUpdates)];
  const UpdateState has{frame, cursor.map, cursor.events, cursor.run};
  const UpdateState is{serial_, map_.version(), events_.size(), run_serial_};
  if (has == is) return nullptr;
  SharedBytes& made = made_[IndexOf(Stream::kUpdates)];
  if (!made || update_made_ != std::pair(has, is)) {
    ProtobufWriter message;
    message.Message(1, StampMessage(stamp_ns())).Message(2, RunMessage());
    if (frame != serial_) message.Message(3, FrameMessage(shown_));
    if (cursor.map != map_.version()) message.Message(4, map_.DeltaSince(cursor.map));
    for (std::size_t i = cursor.events; i < events_.size(); ++i) {
      message.Message(5, EventMessage(events_[i]));
    }
    made = Share(message.Take());
    update_made_ = std::pair(has, is);
  }
  std::tie(frame, cursor.map, cursor.events, cursor.run) = is;
  return made;
}

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

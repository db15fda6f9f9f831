// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/viewer/view_state.h"

#include "plumbline/base/error.h"

#include <algorithm>
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

}  // namespace plumbline

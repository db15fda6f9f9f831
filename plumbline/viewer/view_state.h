// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/slam/system.h"
#include "plumbline/viewer/messages.h"
#include "plumbline/viewer/schemas.h"
#include "plumbline/viewer/viewed_map.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

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

// Description of a run for viewers, in addition to its frames.
struct ViewedRun {
  std::string name;                            // name of the data
  RectifiedCamera camera;                      // camera of the displayed left images
  std::optional<std::size_t> frames_expected;  // nullopt: unknown
  bool can_pause = false;
  bool saved_map = false;  // true: a saved map without frames
};

// The progress of the run.
struct ViewedCounts {
  std::size_t frames = 0, dropped = 0, lost = 0;
  double per_second = 0;  // recent number of frames per second

  friend bool operator==(const ViewedCounts&, const ViewedCounts&) = default;
};

// An event that changed large parts of the map.
struct ViewedEvent {
  enum class Kind { kLoop, kJoin, kRelocalization };
  Kind kind = Kind::kLoop;
  FrameId frame;
  // For a relocalization `keyframe` is the one that matched.
  KeyFrameId keyframe, older;
  int points = 0, lines = 0;
  double moved = 0;
};

// State of one receiver: the last messages that it got.
struct ViewCursor {
  std::array<std::uint64_t, kStreams> frame{};   // serial number of the last frame in each stream
  std::uint64_t map = 0, points = 0, lines = 0;  // versions
  std::int64_t points_at_ns = 0;                 // time at which it got the points
  std::size_t events = 0;
  std::uint64_t run = 0;  // serial number of the description of the run
};

using SharedBytes = std::shared_ptr<const std::string>;

// Current state of a run for viewers, and its messages. A message is made at its first request, and
// shared by all receivers that request the same. Not thread-safe.
class ViewState {
 public:
  // Memory for images of keyframes.
  static constexpr std::size_t kKeptBytes = std::size_t{64} << 20U;
  static constexpr std::int64_t kBetweenCloudsNs = 1'000'000'000;

  explicit ViewState(ViewedRun run) : run_(std::move(run)) {}

  // Sets the current frame, which must have features.
  void Take(ViewedFrame frame);
  void Take(const ViewedCounts& counts);
  void Take(const MapChanges& changes) { map_.Take(changes); }
  void Take(const ViewedEvent& event) { events_.push_back(event); }
  void SetPaused(bool paused);
  void SetFinished();

  // Returns the next message of the stream for the receiver, and counts it as received; null if
  // nothing is new, or if it is not due yet. `now_ns` may be of any clock, the same in all calls of
  // a receiver.
  SharedBytes Next(Stream stream, ViewCursor& cursor, std::int64_t now_ns);

  // Returns plumbline.Frame of a keyframe of the map with its image; null if that is not stored.
  // The newest kKeptBytes of this run are stored.
  SharedBytes KeyFramePicture(ShownId keyframe) const;

  std::int64_t stamp_ns() const { return shown_.stamp_ns(); }

 private:
  // Versions of frame, map, events and run.
  using UpdateState = std::tuple<std::uint64_t, std::uint64_t, std::size_t, std::uint64_t>;

  SharedBytes NextOfFrame(Stream stream, ViewCursor& cursor);
  SharedBytes NextUpdate(ViewCursor& cursor);
  SharedBytes NextPoints(ViewCursor& cursor, std::int64_t now_ns);
  SharedBytes NextLines(ViewCursor& cursor);
  std::string EncodeOfFrame(Stream stream);
  ProtobufWriter RunMessage() const;
  const std::string& Jpeg();
  void KeepPicture();

  ViewedRun run_;
  ViewedCounts counts_;
  ViewedFrame shown_;                // last frame
  std::optional<std::string> jpeg_;  // JPEG file of that frame
  std::uint64_t serial_ = 0;         // serial number of that frame; 0: none
  std::uint64_t run_serial_ = 1;
  bool paused_ = false, finished_ = false;
  ViewedMap map_;
  std::vector<ViewedEvent> events_;
  std::map<std::uint32_t, SharedBytes> pictures_;  // pictures by number of the frame
  std::size_t picture_bytes_ = 0;
  std::array<SharedBytes, kStreams> made_;  // last message of each stream
  std::uint64_t points_made_ = 0;           // version of the points in that message
  // Versions of the receiver before and after the last message of lines, and the last update.
  std::pair<std::uint64_t, std::uint64_t> lines_made_;
  std::pair<UpdateState, UpdateState> update_made_;
};

}  // namespace plumbline

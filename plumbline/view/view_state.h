// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/foxglove/schemas.h"
#include "plumbline/view/viewed_frame.h"
#include "plumbline/view/viewed_map.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

namespace plumbline {

// What is shown of a run besides its frames.
struct ViewedRun {
  std::string name;                            // of the data
  RectifiedCamera camera;                      // of the left images that are shown
  std::optional<std::size_t> frames_expected;  // nullopt: nobody knows
  bool can_pause = false;
};

// How the run goes.
struct ViewedCounts {
  std::size_t frames = 0, dropped = 0, lost = 0;
  double per_second = 0;  // frames, lately

  friend bool operator==(const ViewedCounts&, const ViewedCounts&) = default;
};

// Something that changed the map at large.
struct ViewedEvent {
  enum class Kind { kLoop, kJoin, kRelocalization };
  Kind kind = Kind::kLoop;
  FrameId frame;
  KeyFrameId keyframe, older;  // of a relocalization: keyframe, the one that showed the way
  int points = 0, lines = 0;
  double moved = 0;
};

// How much of what there is one receiver has got.
struct ViewCursor {
  std::array<std::uint64_t, kStreams> frame{};   // by stream: serial number
  std::uint64_t map = 0, points = 0, lines = 0;  // versions
  std::int64_t points_at_ns = 0;                 // when it got the points
  std::size_t events = 0;
  std::uint64_t run = 0;  // serial number of what is said of the run
};

using SharedBytes = std::shared_ptr<const std::string>;

// What there is to be seen of a run now, and the messages that tell it: each is made when somebody
// asks for it first, and shared by all who ask for the same. For one thread.
class ViewState {
 public:
  static constexpr std::size_t kKeptBytes = std::size_t{64} << 20U;  // of pictures of keyframes
  static constexpr std::int64_t kBetweenCloudsNs = 1'000'000'000;

  explicit ViewState(ViewedRun run) : run_(std::move(run)) {}

  // Of a frame that has features.
  void Take(ViewedFrame frame);
  void Take(const ViewedCounts& counts);
  void Take(const MapChanges& changes) { map_.Take(changes); }
  void Take(const ViewedEvent& event) { events_.push_back(event); }
  void SetPaused(bool paused);
  void SetFinished();

  // The message of the stream that the receiver lacks, which it has from now on; null where there
  // is nothing new, or not yet. `now_ns`: of any clock that the receiver keeps to.
  SharedBytes Next(Stream stream, ViewCursor& cursor, std::int64_t now_ns);

  // plumbline.Frame of a keyframe of the map with its image, null where it is not kept: the newest
  // kKeptBytes of this run are.
  SharedBytes KeyFramePicture(ShownId keyframe) const;

  std::int64_t stamp_ns() const { return shown_.stamp_ns(); }

 private:
  // Frame, map, events and run.
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
  ViewedFrame shown_;                // the last frame
  std::optional<std::string> jpeg_;  // of the frame shown
  std::uint64_t serial_ = 0;         // of the frame shown; 0: none
  std::uint64_t run_serial_ = 1;
  bool paused_ = false, finished_ = false;
  ViewedMap map_;
  std::vector<ViewedEvent> events_;
  std::map<std::uint32_t, SharedBytes> pictures_;  // by number of the frame
  std::size_t picture_bytes_ = 0;
  std::array<SharedBytes, kStreams> made_;  // last, by stream
  std::uint64_t points_made_ = 0;           // version that they are of
  // What the receiver had, and had afterwards.
  std::pair<std::uint64_t, std::uint64_t> lines_made_;
  std::pair<UpdateState, UpdateState> update_made_;
};

}  // namespace plumbline

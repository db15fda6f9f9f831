// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/slam/map_events.h"
#include "plumbline/slam/system.h"
#include "plumbline/viewer/map_comparison.h"
#include "plumbline/viewer/view_clients.h"
#include "plumbline/viewer/view_recorder.h"
#include "plumbline/viewer/view_state.h"
#include "plumbline/viewer/web_server.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace plumbline {

struct ViewerOptions {
  std::optional<WebAccess> access;  // where to listen; nullopt: nowhere
  // MCAP file that records the same channels.
  std::optional<std::filesystem::path> record;
  // Whether the run waits until a frame can be recorded; otherwise the frame is left out.
  bool record_all = false;
};

// Shows a run, or a saved map, in browsers and in programs that know Foxglove's protocol, while it
// goes on, and records what they would be sent. One thread of low priority encodes and sends
// everything. The threads of the run hand over copies: of a frame while somebody looks or where it
// is a keyframe, and of what changed in the map while somebody looks. Results do not depend on it.
class Viewer {
 public:
  static constexpr std::size_t kMostFramesWaiting = 8;  // when more wait, the oldest is left out
  // The map is looked at so seldom that this takes at most a 20th of the time.
  static constexpr int kRestAfterLook = 20;

  // Begins to listen. Throws InputError where that is not possible, or the file cannot be written.
  // `session` is that of MapComparison. `picture` returns plumbline.Frame of keyframes of which no
  // frame was shown; it may be empty.
  Viewer(const ViewerOptions& options,
         const ViewedRun& run,
         std::optional<SessionId> session,
         std::function<SharedBytes(ShownId keyframe)> picture = {});
  // Ends all connections and completes the recording.
  ~Viewer();
  Viewer(const Viewer&) = delete;
  Viewer& operator=(const Viewer&) = delete;

  // Returns the address for a browser.
  std::string url() const { return server_.url(); }

  // --- in the thread that tracks ---

  // Takes a frame; to be called after each frame. relocalizations: all so far.
  void Show(const FrameRecord& record,
            const FrameView& view,
            std::span<const Relocalization> relocalizations);
  // Returns whether ReadMaps is to be called soon, in the thread that maps; true only once for
  // each call of that. new_keyframe: the map has changed, or will.
  bool WantsMaps(bool new_keyframe);
  // Takes over what changed in the map, and answers questions about it.
  void ReadMaps(const Atlas& atlas, const MapEvents& events);

  // --- in the thread that feeds ---

  // Returns whether the next frame is to wait: somebody paused the run and has not asked for a
  // step.
  bool HoldsBack();

  // To be called when the run is complete. Shows the maps as they are and waits, at most a second,
  // until all viewers have got them. No other function may be called at the same time.
  void Finish(const Atlas& atlas, const MapEvents& events);

  // Returns what went wrong in the thread of the viewer, which then no longer serves or records;
  // only once.
  std::optional<std::string> TakeFailure();
  // Returns why there is no complete recording; nullopt where there is one, or none was asked for.
  std::optional<std::string> RecordingFailure();

 private:
  using Clock = std::chrono::steady_clock;

  // What the run hands to the viewer's thread.
  struct Mail {
    ViewedCounts counts;
    std::deque<ViewedFrame> frames;
    std::vector<MapChanges> changes;
    std::vector<ViewedEvent> events;
    std::vector<std::pair<CallId, std::string>> answers;
  };

  void Count(const FrameRecord& record);
  WebEvents ServerEvents();
  ViewActions Actions();
  std::optional<WebFile> Get(std::string_view path) const;
  void RunServer();
  void Wake();  // to be called with the mutex held
  void Deliver();
  void NoteWishes();
  void Record();
  void EndRecording();
  void FailRecording(const std::string& why);

  ViewState state_;
  std::unique_ptr<ViewRecorder> recorder_;  // null: nothing is recorded
  std::atomic<bool> recording_;
  bool can_pause_;
  std::function<SharedBytes(ShownId)> picture_;
  ViewClients clients_;
  WebServer server_;
  std::optional<Clock::time_point> wake_at_;  // time at which waking was asked for
  std::atomic<bool> frames_wanted_ = false, map_wanted_ = false, paused_ = false;
  std::atomic<int> steps_ = 0;

  std::mutex mutex_;
  bool record_all_;
  std::condition_variable delivered_;
  Mail mail_;
  bool mail_posted_ = false;
  std::vector<std::pair<CallId, MapQuestion>> questions_;
  std::optional<std::string> failure_, recording_failure_;
  bool broken_ = false;            // the thread has ended
  std::size_t not_recorded_ = 0;   // frames that were not recorded
  bool looking_ = false;           // ReadMaps is to be called
  bool map_is_to_be_seen_ = true;  // a part of the map has not been looked at
  Clock::time_point next_look_;
  std::size_t loops_ = 0, joins_ = 0, relocalizations_ = 0;  // numbers that were told
  ViewedCounts counts_;
  std::deque<Clock::time_point> arrivals_;  // arrival times of the last frames

  MapComparison comparison_;  // used by the thread that maps
  std::jthread thread_;       // declared last, so that it ends before what it uses
};

}  // namespace plumbline

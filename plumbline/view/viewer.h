// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/slam/map_events.h"
#include "plumbline/slam/system.h"
#include "plumbline/view/map_comparison.h"
#include "plumbline/view/view_clients.h"
#include "plumbline/view/view_recorder.h"
#include "plumbline/view/view_state.h"
#include "plumbline/view/web_server.h"

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
  std::optional<WebAccess> access;              // where to listen; nullopt: nowhere
  std::optional<std::filesystem::path> record;  // MCAP file that the same channels go into
  bool record_all = false;  // the run waits until a frame can be recorded; else it is left out
};

// Shows a run, or a saved map, in browsers and in programs that know Foxglove's protocol, while it
// goes on, and records what they would be sent. Everything is encoded and sent in one thread of low
// priority; the threads of the run hand over copies: of a frame while somebody looks or where it is
// a keyframe, of what changed in the map while somebody looks. Results do not depend on it.
class Viewer {
 public:
  static constexpr std::size_t kMostFramesWaiting = 8;  // then the oldest goes
  // The map is looked at so rarely that this takes at most a 20th of the time.
  static constexpr int kRestAfterLook = 20;

  // Listens from now on; InputError where that is not possible, or the file cannot be written.
  // session: as of MapComparison.
  // `picture`: plumbline.Frame of keyframes that no frame was shown of, may be empty.
  Viewer(const ViewerOptions& options,
         const ViewedRun& run,
         std::optional<SessionId> session,
         std::function<SharedBytes(ShownId keyframe)> picture = {});
  // Ends all connections, completes the recording.
  ~Viewer();
  Viewer(const Viewer&) = delete;
  Viewer& operator=(const Viewer&) = delete;

  // The address for a browser.
  std::string url() const { return server_.url(); }

  // --- in the thread that tracks ---

  // After each frame. relocalizations: all so far.
  void Show(const FrameRecord& record,
            const FrameView& view,
            std::span<const Relocalization> relocalizations);
  // Whether LookAtMaps is to be called soon, in the thread that maps; says so once for each call.
  // new_keyframe: the map has changed, or will.
  bool WantsMaps(bool new_keyframe);
  // What changed in the map, and answers to questions about it.
  void LookAtMaps(const Atlas& atlas, const MapEvents& events);

  // --- in the thread that feeds ---

  // Whether the next frame is to wait: somebody paused the run, and asked for no step.
  bool HoldsBack();

  // When the run is complete: shows the maps as they are and waits, at most a second, until all who
  // look have got it. No other function may be called at the same time.
  void Finish(const Atlas& atlas, const MapEvents& events);

  // What went wrong in the thread of the viewer, which serves or records nobody any more; once.
  std::optional<std::string> TakeFailure();
  // Why there is no whole recording; nullopt where there is one, or none was asked for.
  std::optional<std::string> RecordingFailure();

 private:
  using Clock = std::chrono::steady_clock;

  // From the run to the viewer's thread.
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
  void Wake();  // with the mutex held
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
  std::optional<Clock::time_point> wake_at_;  // that was asked for
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
  std::size_t not_recorded_ = 0;   // frames
  bool looking_ = false;           // LookAtMaps is to be called
  bool map_is_to_be_seen_ = true;  // something of it has not been looked at
  Clock::time_point next_look_;
  std::size_t loops_ = 0, joins_ = 0, relocalizations_ = 0;  // told
  ViewedCounts counts_;
  std::deque<Clock::time_point> arrivals_;  // of the last frames

  MapComparison comparison_;  // of the thread that maps
  std::jthread thread_;       // last, so that it ends first
};

}  // namespace plumbline

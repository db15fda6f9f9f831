// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/io/recordings/mcap_file_writer.h"
#include "plumbline/slam/map_events.h"
#include "plumbline/slam/system.h"
#include "plumbline/viewer/map_comparison.h"
#include "plumbline/viewer/view_clients.h"
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

// Returns the page of the viewer, one file with its style and scripts. CMake builds it into the
// library, from view_page.html, view_*.css, view_*.js and the files shared with report.html.
std::shared_ptr<const std::string> ViewPage();

// Records the messages of viewers in an MCAP file: the same channels, for every frame, with the
// stamps of the sensor.
class ViewRecorder {
 public:
  // Creates the file. Throws InputError if it cannot be written, as do all functions.
  explicit ViewRecorder(const std::filesystem::path& path);

  // Writes the messages new since the last call. Call it after each frame.
  void Record(ViewState& state);
  void Close() { file_.Close(); }

 private:
  McapFileWriter file_;
  ViewCursor cursor_;
};

struct ViewerOptions {
  std::optional<WebAccess> access;  // address to listen on; nullopt: none
  // MCAP file that records the same channels.
  std::optional<std::filesystem::path> record;
  // True: the run waits until a frame can be recorded; false: frames may be dropped.
  bool record_all = false;
};

// Shows a run in progress, or a saved map, in browsers and in programs with Foxglove's protocol,
// and records the same messages. One thread of low priority encodes and sends everything. The
// threads of the run pass copies: of a frame if a viewer is connected or if it is a keyframe, and
// of the changes of the map while a viewer is connected. Results of the run do not depend on it.
class Viewer {
 public:
  static constexpr std::size_t kMostFramesWaiting = 8;  // beyond it, the oldest is dropped
  // Rest after each comparison of the map, in multiples of its duration: at most a 20th of the
  // time.
  static constexpr int kRestAfterLook = 20;

  // Starts to listen. Throws InputError if that is impossible, or if the file cannot be written.
  // `session` is that of MapComparison. `picture` returns plumbline.Frame of keyframes without a
  // displayed frame; it may be empty.
  Viewer(const ViewerOptions& options,
         const ViewedRun& run,
         std::optional<SessionId> session,
         std::function<SharedBytes(ShownId keyframe)> picture = {});
  // Closes all connections and completes the recording.
  ~Viewer();
  Viewer(const Viewer&) = delete;
  Viewer& operator=(const Viewer&) = delete;

  // Returns the address for a browser.
  std::string url() const { return server_.url(); }

  // --- in the tracking thread ---

  // Shows a frame; call it after each frame. relocalizations: those since the last call.
  void Show(const FrameRecord& record,
            const FrameView& view,
            std::span<const Relocalization> relocalizations);
  // Returns true if ReadMaps should be called soon, in the mapping thread; only once for each call
  // of ReadMaps. new_keyframe: the map has changed, or will.
  bool WantsMaps(bool new_keyframe);
  // Reads the changes of the map, and answers queries about it.
  void ReadMaps(const Atlas& atlas, const MapEvents& events);

  // --- in the thread that reads frames ---

  // Returns true if the next frame must wait: a viewer paused the run and has not requested a step.
  bool HoldsBack();

  // Call it when the run is complete. Shows the final maps and waits, at most a second, until all
  // viewers have received them. No other function may be called at the same time.
  void Finish(const Atlas& atlas, const MapEvents& events);

  // Returns the failure of the viewer's thread, which then no longer serves or records; only once.
  std::optional<std::string> TakeFailure();
  // Returns why the recording is incomplete; nullopt if it is complete, or none was requested.
  std::optional<std::string> RecordingFailure();

 private:
  using Clock = std::chrono::steady_clock;

  // Data passed from the run to the viewer's thread.
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
  void Wake();  // requires the mutex
  void Deliver();
  void NoteWishes();
  void Record();
  void EndRecording();
  void FailRecording(const std::string& why);

  ViewState state_;
  std::unique_ptr<ViewRecorder> recorder_;  // null: no recording
  std::atomic<bool> recording_;
  bool can_pause_;
  std::function<SharedBytes(ShownId)> picture_;
  ViewClients clients_;
  WebServer server_;
  std::optional<Clock::time_point> wake_at_;  // requested time to wake up
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
  std::size_t not_recorded_ = 0;   // number of frames not recorded
  bool looking_ = false;           // ReadMaps should be called
  bool map_is_to_be_seen_ = true;  // a part of the map has not been read
  Clock::time_point next_look_;
  std::size_t loops_ = 0, joins_ = 0;  // reported numbers
  ViewedCounts counts_;
  std::deque<Clock::time_point> arrivals_;  // arrival times of the last frames

  MapComparison comparison_;  // used by the thread that maps
  std::jthread thread_;       // declared last: it ends before the members that it uses
};

}  // namespace plumbline

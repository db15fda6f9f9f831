// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/viewer/viewer.h"

#include "plumbline/base/error.h"

#include <algorithm>
#include <charconv>
#include <exception>
#include <iterator>

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

namespace plumbline {
namespace {

constexpr std::size_t kMostQuestions = 64;
constexpr auto kLastWait = std::chrono::seconds(1);
constexpr auto kAskAgain = std::chrono::milliseconds(10);

// Lowers the priority of the calling thread, so that the run goes first on a busy machine.
void LowerPriority() {
  constexpr int kLow = 10;
  setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), kLow);
}

ViewedEvent EventOf(const Recognition& place, ViewedEvent::Kind kind) {
  return {kind, place.frame, place.keyframe, place.older, place.points, place.lines, place.moved};
}

ViewedEvent EventOf(const Relocalization& r) {
  return {ViewedEvent::Kind::kRelocalization, r.frame, r.keyframe, {}, r.points, r.lines, 0};
}

// Returns the number in "/keyframe/12".
std::optional<ShownId> KeyFrameOf(std::string_view path) {
  constexpr std::string_view kPrefix = "/keyframe/";
  if (!path.starts_with(kPrefix)) return std::nullopt;
  path.remove_prefix(kPrefix.size());
  ShownId id = 0;
  const char* end = path.data() + path.size();
  const auto [stop, error] = std::from_chars(path.data(), end, id);
  return error == std::errc() && stop == end ? std::optional(id) : std::nullopt;
}

}  // namespace

Viewer::Viewer(const ViewerOptions& options,
               const ViewedRun& run,
               std::optional<SessionId> session,
               std::function<SharedBytes(ShownId)> picture)
    : state_(run),
      recorder_(options.record ? std::make_unique<ViewRecorder>(*options.record) : nullptr),
      recording_(options.record.has_value()),
      can_pause_(run.can_pause),
      picture_(std::move(picture)),
      clients_(state_, run.name, can_pause_, Actions()),
      server_(options.access, ServerEvents()),
      record_all_(options.record && options.record_all),
      comparison_(session),
      thread_([this] { RunServer(); }) {
  if (options.record) frames_wanted_ = map_wanted_ = true;
}

Viewer::~Viewer() { server_.Stop(); }

void Viewer::RunServer() {
  LowerPriority();
  try {
    server_.Run();
  } catch (const std::exception& error) {
    const std::lock_guard lock(mutex_);
    failure_ = std::string("the viewer has stopped: ") + error.what();
    if (recording_) recording_failure_ = failure_;
    broken_ = true;
    recording_ = false;
    delivered_.notify_all();
    frames_wanted_ = map_wanted_ = paused_ = false;
  }
}

WebEvents Viewer::ServerEvents() {
  WebEvents events;
  events.get = [this](std::string_view path) { return Get(path); };
  events.opened = [this](WebClient& client) { clients_.Opened(client); };
  events.received = [this](WebClient& client, std::string_view message, bool binary) {
    clients_.Received(client, message, binary);
    NoteWishes();
  };
  events.drained = [this](WebClient& client) { clients_.Serve(client); };
  events.closed = [this](WebClient& client) {
    clients_.Closed(client);
    NoteWishes();
  };
  return events;
}

ViewActions Viewer::Actions() {
  ViewActions actions;
  actions.pause = [this](bool paused) {
    steps_ = 0;
    paused_ = paused;
    state_.SetPaused(paused);
    clients_.ServeAll();
  };
  actions.step = [this] {
    if (paused_) ++steps_;
  };
  actions.ask = [this](CallId id, const MapQuestion& question) {
    const std::lock_guard lock(mutex_);
    if (questions_.size() >= kMostQuestions) return false;
    questions_.emplace_back(id, question);
    return true;
  };
  actions.wake_at = [this](Clock::time_point time) {
    if (wake_at_) return;
    wake_at_ = time;
    server_.PostAt(time, [this] {
      wake_at_.reset();
      clients_.ServeAll();
    });
  };
  return actions;
}

std::optional<WebFile> Viewer::Get(std::string_view path) const {
  if (path == "/") return WebFile{"text/html; charset=utf-8", ViewPage()};
  const auto keyframe = KeyFrameOf(path);
  if (!keyframe) return std::nullopt;
  SharedBytes picture = state_.KeyFramePicture(*keyframe);
  if (picture == nullptr && picture_) picture = picture_(*keyframe);
  if (picture == nullptr) return std::nullopt;
  return WebFile{"application/x-protobuf", std::move(picture)};
}

// Records whether viewers or the recording want frames and the map. A pause ends when no viewer is
// left, since only viewers can pause a run.
void Viewer::NoteWishes() {
  frames_wanted_ = recorder_ != nullptr || clients_.frames_wanted();
  map_wanted_ = recorder_ != nullptr || clients_.map_wanted();
  if (!clients_.frames_wanted() && paused_) {
    paused_ = false;
    state_.SetPaused(false);
  }
}

void Viewer::Wake() {
  if (mail_posted_ || broken_) return;
  mail_posted_ = true;
  server_.Post([this] { Deliver(); });
}

void Viewer::Deliver() {
  Mail mail;
  {
    const std::lock_guard lock(mutex_);
    mail = std::exchange(mail_, Mail{mail_.counts, {}, {}, {}, {}});
    mail_posted_ = false;
  }
  state_.Take(mail.counts);
  for (const MapChanges& changes : mail.changes) state_.Take(changes);
  for (const ViewedEvent& event : mail.events) state_.Take(event);
  for (ViewedFrame& frame : mail.frames) {
    state_.Take(std::move(frame));
    Record();
  }
  for (const auto& [id, json] : mail.answers) clients_.Answer(id, json);
  clients_.ServeAll();
  delivered_.notify_all();
}

void Viewer::Record() {
  if (recorder_ == nullptr) return;
  try {
    recorder_->Record(state_);
  } catch (const InputError& error) {
    FailRecording(error.what());
  }
}

void Viewer::FailRecording(const std::string& why) {
  recorder_.reset();
  recording_ = false;
  NoteWishes();
  const std::lock_guard lock(mutex_);
  record_all_ = false;
  failure_ = recording_failure_ = why;
}

void Viewer::Count(const FrameRecord& record) {
  // Number of frames over which frames per second are counted.
  constexpr std::size_t kArrivals = 30;
  ++counts_.frames;
  counts_.dropped += record.shed == LoadLevel::kFrame;
  counts_.lost += record.status == FrameStatus::kLost;
  arrivals_.push_back(Clock::now());
  if (arrivals_.size() > kArrivals) arrivals_.pop_front();
  const std::chrono::duration<double> taken = arrivals_.back() - arrivals_.front();
  if (taken.count() > 0) {
    counts_.per_second = static_cast<double>(arrivals_.size() - 1) / taken.count();
  }
}

void Viewer::Show(const FrameRecord& record,
                  const FrameView& view,
                  std::span<const Relocalization> relocalizations) {
  Count(record);
  const bool wanted = frames_wanted_;
  std::optional<ViewedFrame> frame;
  if (view.frame.indexed != nullptr && (wanted || record.keyframe)) {
    frame = ViewedFrameOf(record, view);
  }
  std::unique_lock lock(mutex_);
  if (record_all_ && frame) {
    delivered_.wait(
        lock, [&] { return mail_.frames.size() < kMostFramesWaiting || !record_all_ || broken_; });
  }
  mail_.counts = counts_;
  for (const Relocalization& found : relocalizations) mail_.events.push_back(EventOf(found));
  if (frame) mail_.frames.push_back(*std::move(frame));
  if (mail_.frames.size() > kMostFramesWaiting) {
    mail_.frames.pop_front();
    ++not_recorded_;
  }
  if (wanted || !mail_.frames.empty()) Wake();
}

bool Viewer::WantsMaps(bool new_keyframe) {
  const std::lock_guard lock(mutex_);
  map_is_to_be_seen_ = map_is_to_be_seen_ || new_keyframe;
  if (looking_ || broken_) return false;
  const bool due =
      map_wanted_ && map_is_to_be_seen_ && Clock::now() >= next_look_ && mail_.changes.empty();
  if (questions_.empty() && !due) return false;
  looking_ = true;
  map_is_to_be_seen_ = false;
  return true;
}

void Viewer::ReadMaps(const Atlas& atlas, const MapEvents& events) {
  const auto start = Clock::now();
  std::vector<std::pair<CallId, MapQuestion>> questions;
  {
    const std::lock_guard lock(mutex_);
    questions = std::exchange(questions_, {});
  }
  std::vector<std::pair<CallId, std::string>> answers;
  for (const auto& [id, question] : questions) {
    answers.emplace_back(id, AnswerMapQuestion(atlas, question));
  }
  MapChanges changes = comparison_.Compare(atlas);
  const std::lock_guard lock(mutex_);
  for (; loops_ < events.loops.size(); ++loops_) {
    mail_.events.push_back(EventOf(events.loops[loops_], ViewedEvent::Kind::kLoop));
  }
  for (; joins_ < events.joins.size(); ++joins_) {
    mail_.events.push_back(EventOf(events.joins[joins_].place, ViewedEvent::Kind::kJoin));
  }
  mail_.changes.push_back(std::move(changes));
  // The viewer's thread may not have taken those before yet.
  std::move(answers.begin(), answers.end(), std::back_inserter(mail_.answers));
  looking_ = false;
  map_is_to_be_seen_ = map_is_to_be_seen_ || comparison_.HasMore();
  next_look_ = Clock::now() + kRestAfterLook * (Clock::now() - start);
  Wake();
}

bool Viewer::HoldsBack() {
  if (!paused_) return false;
  if (steps_ > 0) {
    --steps_;
    return false;
  }
  return true;
}

void Viewer::Finish(const Atlas& atlas, const MapEvents& events) {
  if (map_wanted_) {
    do {
      ReadMaps(atlas, events);
    } while (comparison_.HasMore());
  }
  // A recording is completed, however long that takes.
  const auto until = Clock::now() + kLastWait;
  const auto served = std::make_shared<std::atomic<bool>>(false);
  server_.Post([this] {
    state_.SetFinished();
    clients_.ServeAll();
    EndRecording();
  });
  while (!*served && (Clock::now() < until || recording_)) {
    server_.Post([this, served] { *served = recorder_ == nullptr && clients_.all_served(); });
    std::this_thread::sleep_for(kAskAgain);
  }
}

void Viewer::EndRecording() {
  if (recorder_ == nullptr) return;
  Record();
  try {
    if (recorder_) recorder_->Close();
  } catch (const InputError& error) {
    return FailRecording(error.what());
  }
  recorder_.reset();
  recording_ = false;
  const std::lock_guard lock(mutex_);
  record_all_ = false;
  if (not_recorded_ > 0) {
    failure_ = fmt::format("{} frames are not in the recording: it was behind", not_recorded_);
  }
}

std::optional<std::string> Viewer::TakeFailure() {
  const std::lock_guard lock(mutex_);
  return std::exchange(failure_, std::nullopt);
}

std::optional<std::string> Viewer::RecordingFailure() {
  const std::lock_guard lock(mutex_);
  return recording_failure_;
}

ViewRecorder::ViewRecorder(const std::filesystem::path& path) : file_(path) {
  for (const FoxgloveChannel& channel : FoxgloveChannels()) {
    file_.AddChannel({std::string(channel.topic),
                      "protobuf",
                      std::string(channel.type),
                      "protobuf",
                      FoxgloveSchemas()});
  }
}

void ViewRecorder::Record(ViewState& state) {
  const std::int64_t stamp_ns = state.stamp_ns();
  for (unsigned i = 0; i < kStreams; ++i) {
    const SharedBytes message = state.Next(static_cast<Stream>(i), cursor_, stamp_ns);
    if (message) file_.Write(static_cast<std::uint16_t>(i), stamp_ns, *message);
  }
}

}  // namespace plumbline

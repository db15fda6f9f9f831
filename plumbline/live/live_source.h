// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/image/image.h"
#include "plumbline/io/dataset.h"

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

namespace plumbline {

// A frame that could not be read; later frames may be fine.
struct MissingFrame {
  std::int64_t stamp_ns = 0;
  std::string reason;  // a word for tables: "image_unreadable", "image_size"
  std::string why;     // for people
};

// The end of a source: there will be no more frames.
struct SourceEnd {
  // For people; empty where the source itself said that this is all.
  std::string why;
};

using LiveEvent = std::variant<SensorFrame, MissingFrame, SourceEnd>;

// A source of frames that arrive at their own time: a camera, a network stream, another program. It
// is for running sources what Dataset is for recordings.
class LiveSource {
 public:
  explicit LiveSource(DatasetInfo info) : info_(std::move(info)) {}
  LiveSource(const LiveSource&) = delete;
  LiveSource& operator=(const LiveSource&) = delete;
  virtual ~LiveSource() = default;

  // What is known of the source. It has no stamps, since nobody knows them yet.
  const DatasetInfo& info() const { return info_; }

  // Waits for the next frame, however long that takes. Stamps are the source's own and may jump,
  // even backwards (stamp_continuity.h). May not be called again after a SourceEnd. Throws
  // InputError for data that contradict the form of the stream.
  virtual LiveEvent Next() = 0;

 private:
  DatasetInfo info_;
};

struct LiveOptions {
  std::optional<SensorKind> sensor = std::nullopt;   // nullopt: the richest the source offers
  std::optional<std::string> camera = std::nullopt;  // camera file, or name of a built-in camera
  bool side_by_side = false;                         // each image is a left and a right half
  // As DatasetOptions; nothing but `rotate` turns the images of a live source.
  Rotation rotate = Rotation::kAuto;
  std::optional<int> max_width = std::nullopt;
  // How long a camera, stream or pipeline may take until its first frame.
  std::chrono::milliseconds patience = std::chrono::seconds(20);
};

// Returns which kind of source a name on the command line stands for; nullopt for a path.
enum class LiveKind { kStandardInput, kCamera, kNetwork, kGstreamer };
std::optional<LiveKind> LiveKindOf(std::string_view name);

// Returns the name without passwords: those of URLs, rtsp://user:***@host/, and those that elements
// of GStreamer take, user-pw=*** (proxy-pw, password, passwd).
std::string WithoutPassword(const std::string& name);

// The frames of a source after they have passed, for reports: what is known of them, without
// images.
class PassedFrames : public Dataset {
 public:
  using Dataset::Dataset;
  Expected<SensorFrame, ImageFailure> Read(std::size_t i) const override;
};

}  // namespace plumbline

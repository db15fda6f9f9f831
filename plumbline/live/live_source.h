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

// A frame that could not be had; what comes after it may be fine.
struct MissingFrame {
  std::int64_t stamp_ns = 0;
  std::string reason;  // a word for tables: "image_unreadable", "image_size"
  std::string why;     // for people
};

// There will be no more frames.
struct SourceEnd {
  std::string why;  // for people; empty where the source said itself that this is all
};

using LiveEvent = std::variant<SensorFrame, MissingFrame, SourceEnd>;

// Frames that come when they come: of a camera, a network stream, another program. What Dataset is
// for recordings.
class LiveSource {
 public:
  explicit LiveSource(DatasetInfo info) : info_(std::move(info)) {}
  LiveSource(const LiveSource&) = delete;
  LiveSource& operator=(const LiveSource&) = delete;
  virtual ~LiveSource() = default;

  // Without stamps, which nobody knows yet.
  const DatasetInfo& info() const { return info_; }

  // Waits for the next frame, however long that takes. Stamps are the source's own and may jump,
  // also back (stamp_continuity.h). After a SourceEnd it is not to be called again. InputError for
  // what contradicts the form of the stream.
  virtual LiveEvent Next() = 0;

 private:
  DatasetInfo info_;
};

struct LiveOptions {
  std::optional<SensorKind> sensor = std::nullopt;   // nullopt: the richest the source offers
  std::optional<std::string> camera = std::nullopt;  // camera file, or name of a built-in camera
  bool side_by_side = false;                         // each image is a left and a right half
  // How long a camera, stream or pipeline may take until its first frame.
  std::chrono::milliseconds patience = std::chrono::seconds(20);
};

// What kind of source a name on the command line stands for; nullopt for a path.
enum class LiveKind { kStandardInput, kCamera, kNetwork, kGstreamer };
std::optional<LiveKind> LiveKindOf(std::string_view name);

// The name without the password that a URL may have: rtsp://user:***@host/.
std::string WithoutPassword(const std::string& name);

// The frames of a source when they have passed, for reports: what is known of them, and no images.
class PassedFrames : public Dataset {
 public:
  using Dataset::Dataset;
  Expected<SensorFrame, ImageFailure> Read(std::size_t i) const override;
};

}  // namespace plumbline

// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/image/image.h"
#include "plumbline/inertial/inertial_sample.h"
#include "plumbline/io/datasets/dataset.h"
#include "plumbline/io/inertial/inertial_stream.h"

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace plumbline {

// A frame that could not be read; later frames may be fine.
struct MissingFrame {
  std::int64_t stamp_ns = 0;
  std::string reason;  // code for tables: "image_unreadable", "image_size"
  std::string why;     // for users
};

// End of a source: no more frames follow.
struct SourceEnd {
  // For users; empty after a regular end.
  std::string why;
};

using LiveEvent = std::variant<SensorFrame, MissingFrame, SourceEnd>;

// A source of frames in real time: a camera, a network stream, another program. The counterpart of
// Dataset for live sources.
class LiveSource {
 public:
  explicit LiveSource(DatasetInfo info) : info_(std::move(info)) {}
  LiveSource(const LiveSource&) = delete;
  LiveSource& operator=(const LiveSource&) = delete;
  virtual ~LiveSource() = default;

  // Description of the source, without stamps, which are not known yet.
  const DatasetInfo& info() const { return info_; }

  // Waits for the next frame, without a time limit. Stamps are the source's own and may jump, even
  // backwards (stamp_continuity.h). Must not be called after a SourceEnd. Throws InputError for
  // data that violate the format of the stream.
  virtual LiveEvent Next() = 0;

  // Returns true if samples of an inertial sensor come between the frames.
  virtual bool HasInertial() const { return false; }
  // Returns the samples that came since the last call, before the frame that Next returned last.
  // Those that cannot be used are left out.
  virtual std::vector<InertialSample> TakeInertial() { return {}; }
  // What of the samples was left out so far.
  virtual UnusableSamples UnusableInertial() const { return {}; }

 private:
  DatasetInfo info_;
};

struct LiveOptions {
  std::optional<SensorKind> sensor = std::nullopt;   // nullopt: the richest the source offers
  std::optional<std::string> camera = std::nullopt;  // camera file, or name of a built-in camera
  bool side_by_side = false;                         // each image is a left and a right half
  // As DatasetOptions; only `rotate` turns the images of a live source.
  Rotation rotate = Rotation::kAuto;
  std::optional<int> max_width = std::nullopt;
  std::optional<double> view_angle_deg = std::nullopt;
  std::vector<std::string> masks = {};
  // Longest time until the first frame of a camera, stream or pipeline.
  std::chrono::milliseconds patience = std::chrono::seconds(20);
};

// Returns the kind of source of a name on the command line; nullopt for a path.
enum class LiveKind { kStandardInput, kCamera, kNetwork, kGstreamer };
std::optional<LiveKind> LiveKindOf(std::string_view name);

// Returns the name without passwords: those of URLs, rtsp://user:***@host/, and those of GStreamer
// elements, user-pw=*** (proxy-pw, password, passwd).
std::string WithoutPassword(const std::string& name);

// Processed frames of a live source, for reports: their descriptions, without images.
class PassedFrames : public Dataset {
 public:
  using Dataset::Dataset;
  Expected<SensorFrame, ImageFailure> Read(std::size_t i) const override;
};

}  // namespace plumbline

// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/live/live_source.h"

#include "plumbline/live/capture_source.h"
#include "plumbline/live/raw_stream.h"

#include <unistd.h>

namespace plumbline {

std::optional<LiveKind> LiveKindOf(std::string_view name) {
  if (name == "-") return LiveKind::kStandardInput;
  if (name.starts_with("camera:")) return LiveKind::kCamera;
  if (name.starts_with("rtsp://") || name.starts_with("rtsps://")) return LiveKind::kNetwork;
  if (name.starts_with("gst:")) return LiveKind::kGstreamer;
  return std::nullopt;
}

std::unique_ptr<LiveSource> OpenLiveSource(const std::string& name, const LiveOptions& options) {
  const auto kind = LiveKindOf(name);
  PLUMBLINE_CHECK(kind.has_value(), "the name of a live source");
  if (*kind != LiveKind::kStandardInput) return OpenCapture(name, *kind, options);
  if (options.side_by_side) {
    throw InputError(
        "--side-by-side: expected a camera, found standard input, whose header names "
        "both images");
  }
  return OpenRawStream(STDIN_FILENO, options);
}

std::string WithoutPassword(const std::string& name) {
  const std::size_t scheme = name.find("://");
  if (scheme == std::string::npos) return name;
  const std::size_t host = scheme + 3;
  const std::size_t at = name.substr(0, name.find('/', host)).rfind('@');
  const std::size_t colon = name.find(':', host);
  if (at == std::string::npos || at < host || colon == std::string::npos || colon > at) return name;
  return name.substr(0, colon + 1) + "***" + name.substr(at);
}

Expected<SensorFrame, ImageFailure> PassedFrames::Read(std::size_t) const {
  return ImageFailure{info().path, "a live source keeps no images"};
}

}  // namespace plumbline

// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/live/live_source.h"

namespace plumbline {

std::optional<LiveKind> LiveKindOf(std::string_view name) {
  if (name == "-") return LiveKind::kStandardInput;
  if (name.starts_with("camera:")) return LiveKind::kCamera;
  if (name.starts_with("rtsp://") || name.starts_with("rtsps://")) return LiveKind::kNetwork;
  if (name.starts_with("gst:")) return LiveKind::kGstreamer;
  return std::nullopt;
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

// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/live/live_source.h"

#include <algorithm>
#include <array>
#include <cctype>

namespace plumbline {
namespace {

constexpr std::string_view kHidden = "***";

bool IsBlank(char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; }

// Hides the passwords of all URLs. If a pipeline names several, an authority ends at a blank, too;
// in a single URL a blank may be part of the password.
std::string WithoutUrlPasswords(const std::string& name) {
  constexpr std::string_view kBehindScheme = "://";
  const char* ends = LiveKindOf(name) == LiveKind::kGstreamer ? "/ \t\r\n" : "/";
  std::string shown = name;
  std::size_t scheme = shown.find(kBehindScheme);
  while (scheme != std::string::npos) {
    const std::size_t user = scheme + kBehindScheme.size();
    const std::size_t end = std::min(shown.find_first_of(ends, user), shown.size());
    const std::size_t colon = shown.find(':', user);
    const std::size_t at = shown.rfind('@', end);
    const bool has_password = at != std::string::npos && at < end && colon < at;
    if (has_password) shown.replace(colon + 1, at - colon - 1, kHidden);
    scheme = shown.find(kBehindScheme, user);
  }
  return shown;
}

// Returns the end of a value of a GStreamer pipeline: after its closing quote, or at a blank.
std::size_t EndOfValue(const std::string& text, std::size_t begin) {
  if (begin >= text.size()) return text.size();
  const char quote = text[begin] == '"' || text[begin] == '\'' ? text[begin] : '\0';
  for (std::size_t i = begin + (quote == '\0' ? 0 : 1); i < text.size(); ++i) {
    if (text[i] == '\\') {
      ++i;  // whatever comes next belongs to the value
    } else if (quote != '\0' && text[i] == quote) {
      return i + 1;
    } else if (quote == '\0' && IsBlank(text[i])) {
      return i;
    }
  }
  return text.size();
}

// Hides the values of the properties in which elements of GStreamer take passwords.
std::string WithoutPasswordProperties(std::string shown) {
  constexpr std::array<std::string_view, 4> kProperties = {
      "user-pw", "proxy-pw", "password", "passwd"};
  for (const std::string_view property : kProperties) {
    std::size_t found = shown.find(property);
    while (found != std::string::npos) {
      std::size_t next = found + property.size();
      const auto skip_blanks = [&] {
        while (next < shown.size() && IsBlank(shown[next])) ++next;
      };
      skip_blanks();
      if (next < shown.size() && shown[next] == '=') {
        ++next;
        skip_blanks();
        shown.replace(next, EndOfValue(shown, next) - next, kHidden);
      }
      found = shown.find(property, next);
    }
  }
  return shown;
}

}  // namespace

std::optional<LiveKind> LiveKindOf(std::string_view name) {
  if (name == "-") return LiveKind::kStandardInput;
  if (name.starts_with("camera:")) return LiveKind::kCamera;
  if (name.starts_with("rtsp://") || name.starts_with("rtsps://")) return LiveKind::kNetwork;
  if (name.starts_with("gst:")) return LiveKind::kGstreamer;
  return std::nullopt;
}

std::string WithoutPassword(const std::string& name) {
  return WithoutPasswordProperties(WithoutUrlPasswords(name));
}

Expected<SensorFrame, ImageFailure> PassedFrames::Read(std::size_t) const {
  return ImageFailure{info().path, "a live source keeps no images"};
}

}  // namespace plumbline

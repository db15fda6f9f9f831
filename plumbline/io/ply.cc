// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/ply.h"

#include "plumbline/base/error.h"
#include "plumbline/io/atomic_file.h"

#include <cstddef>
#include <string>

#include <fmt/core.h>

namespace plumbline {
namespace {

constexpr Color kPointGrey{128, 128, 128};
constexpr std::string_view kLineColor = "255 140 0";

// Returns a number with fixed decimals, without a minus sign before zero.
std::string Number(double value) {
  std::string text = fmt::format("{:.6f}", value);
  if (text == "-0.000000") text.erase(0, 1);
  return text;
}

std::string Position(const Eigen::Vector3d& p) {
  return fmt::format("{} {} {}", Number(p.x()), Number(p.y()), Number(p.z()));
}

}  // namespace

void WritePly(const std::filesystem::path& path,
              std::span<const Eigen::Vector3d> points,
              std::span<const Segment3> segments,
              std::span<const Color> colors) {
  PLUMBLINE_CHECK(colors.empty() || colors.size() == points.size(), "a colour for each point");
  std::string out = fmt::format(
      "ply\nformat ascii 1.0\ncomment Plumbline map, metres (of a single camera: units of its "
      "own)\nelement vertex {}\n"
      "property float x\nproperty float y\nproperty float z\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\n"
      "element edge {}\nproperty int vertex1\nproperty int vertex2\nend_header\n",
      points.size() + 2 * segments.size(),
      segments.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Color color = colors.empty() ? kPointGrey : colors[i];
    out += fmt::format("{} {} {} {}\n", Position(points[i]), color.r, color.g, color.b);
  }
  for (const Segment3& segment : segments) {
    out += fmt::format("{} {}\n", Position(segment.start), kLineColor);
    out += fmt::format("{} {}\n", Position(segment.end), kLineColor);
  }
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const std::size_t first = points.size() + 2 * i;
    out += fmt::format("{} {}\n", first, first + 1);
  }
  WriteFileAtomically(path, out);
}

void WriteObjLines(const std::filesystem::path& path, std::span<const Segment3> segments) {
  std::string out = "# Plumbline line segments, metres (of a single camera: units of its own)\n";
  for (const Segment3& segment : segments) {
    out += fmt::format("v {}\nv {}\n", Position(segment.start), Position(segment.end));
  }
  // OBJ counts vertices from 1.
  for (std::size_t i = 0; i < segments.size(); ++i) {
    out += fmt::format("l {} {}\n", 2 * i + 1, 2 * i + 2);
  }
  WriteFileAtomically(path, out);
}

}  // namespace plumbline

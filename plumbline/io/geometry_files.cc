// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/geometry_files.h"

#include "plumbline/base/error.h"
#include "plumbline/io/atomic_file.h"

#include <cstddef>
#include <string>

#include <Eigen/Geometry>
#include <fmt/core.h>

namespace plumbline {
namespace {

constexpr Color kPointGrey{128, 128, 128};
constexpr std::string_view kLineColor = "255 140 0";

// Returns a number with fixed decimals, without a minus sign before zero.
std::string FixedDecimals(double value) {
  std::string text = fmt::format("{:.6f}", value);
  if (text == "-0.000000") text.erase(0, 1);
  return text;
}

std::string Position(const Eigen::Vector3d& p) {
  return fmt::format("{} {} {}", FixedDecimals(p.x()), FixedDecimals(p.y()), FixedDecimals(p.z()));
}

// Returns a point as three groups: x, y, z have the codes `first`, first + 10 and first + 20.
std::string Point(int first, const Eigen::Vector3d& p) {
  return fmt::format("{}\n{}\n{}\n{}\n{}\n{}\n",
                     first,
                     FixedDecimals(p.x()),
                     first + 10,
                     FixedDecimals(p.y()),
                     first + 20,
                     FixedDecimals(p.z()));
}

std::string Header(std::span<const Segment3> segments) {
  Eigen::AlignedBox3d box;
  for (const Segment3& segment : segments) box.extend(segment.start).extend(segment.end);
  if (box.isEmpty()) box.extend(Eigen::Vector3d::Zero());
  return "0\nSECTION\n2\nHEADER\n9\n$ACADVER\n1\nAC1009\n9\n$EXTMIN\n" + Point(10, box.min()) +
         "9\n$EXTMAX\n" + Point(10, box.max()) + "0\nENDSEC\n";
}

// The layer has to be declared before it is used: colour 30 (orange), continuous lines.
constexpr const char* kTables =
    "0\nSECTION\n2\nTABLES\n"
    "0\nTABLE\n2\nLTYPE\n70\n1\n"
    "0\nLTYPE\n2\nCONTINUOUS\n70\n0\n3\nSolid line\n72\n65\n73\n0\n40\n0.0\n0\nENDTAB\n"
    "0\nTABLE\n2\nLAYER\n70\n1\n"
    "0\nLAYER\n2\nPLUMBLINE_LINES\n70\n0\n62\n30\n6\nCONTINUOUS\n0\nENDTAB\n0\nENDSEC\n";

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

void WriteDxfLines(const std::filesystem::path& path, std::span<const Segment3> segments) {
  std::string out = Header(segments) + kTables + "0\nSECTION\n2\nENTITIES\n";
  for (const Segment3& segment : segments) {
    out += "0\nLINE\n8\nPLUMBLINE_LINES\n" + Point(10, segment.start) + Point(11, segment.end);
  }
  out += "0\nENDSEC\n0\nEOF\n";
  WriteFileAtomically(path, out);
}

}  // namespace plumbline

// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/dxf.h"

#include "plumbline/io/atomic_file.h"

#include <string>

#include <Eigen/Geometry>
#include <fmt/core.h>

namespace plumbline {
namespace {

// Returns a number with fixed decimals, without a minus sign before zero.
std::string Number(double value) {
  std::string text = fmt::format("{:.6f}", value);
  if (text == "-0.000000") text.erase(0, 1);
  return text;
}

// Returns a point as three groups: x, y, z have the codes `first`, first + 10 and first + 20.
std::string Point(int first, const Eigen::Vector3d& p) {
  return fmt::format("{}\n{}\n{}\n{}\n{}\n{}\n",
                     first,
                     Number(p.x()),
                     first + 10,
                     Number(p.y()),
                     first + 20,
                     Number(p.z()));
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

void WriteDxfLines(const std::filesystem::path& path, std::span<const Segment3> segments) {
  std::string out = Header(segments) + kTables + "0\nSECTION\n2\nENTITIES\n";
  for (const Segment3& segment : segments) {
    out += "0\nLINE\n8\nPLUMBLINE_LINES\n" + Point(10, segment.start) + Point(11, segment.end);
  }
  out += "0\nENDSEC\n0\nEOF\n";
  WriteFileAtomically(path, out);
}

}  // namespace plumbline

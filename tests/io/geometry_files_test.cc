// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/geometry_files.h"

#include "plumbline/base/error.h"

#include "tests/io/scratch_folder.h"
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

TEST(WritePly, WritesPointsThenSegmentsAsEdges) {
  const ScratchFolder folder;
  const std::vector<Eigen::Vector3d> points = {{1, -2, 0.5}};
  const std::vector<Segment3> segments = {{{0, 0, -1e-9}, {1, 1, 1}}};
  WritePly(folder / "m.ply", points, segments);
  EXPECT_EQ(Contents(folder / "m.ply"),
            "ply\nformat ascii 1.0\ncomment Plumbline map, metres (of a single camera: units of "
            "its own)\nelement vertex 3\n"
            "property float x\nproperty float y\nproperty float z\n"
            "property uchar red\nproperty uchar green\nproperty uchar blue\n"
            "element edge 1\nproperty int vertex1\nproperty int vertex2\nend_header\n"
            "1.000000 -2.000000 0.500000 128 128 128\n"
            "0.000000 0.000000 0.000000 255 140 0\n"
            "1.000000 1.000000 1.000000 255 140 0\n"
            "1 2\n");
}

TEST(WritePly, GivesPointsTheirColours) {
  const ScratchFolder folder;
  const std::vector<Eigen::Vector3d> points = {{1, 2, 3}, {4, 5, 6}};
  const std::vector<Color> colors = {{0, 1, 2}, {255, 254, 3}};
  WritePly(folder / "m.ply", points, {}, colors);
  const std::string text = Contents(folder / "m.ply");
  EXPECT_TRUE(
      text.ends_with("end_header\n1.000000 2.000000 3.000000 0 1 2\n"
                     "4.000000 5.000000 6.000000 255 254 3\n"));
}

TEST(WriteObjLines, CountsVerticesFromOne) {
  const ScratchFolder folder;
  const std::vector<Segment3> segments = {{{0, 0, 0}, {1, 0, 0}}, {{0, 2, 0}, {0, 0, 3}}};
  WriteObjLines(folder / "l.obj", segments);
  EXPECT_EQ(Contents(folder / "l.obj"),
            "# Plumbline line segments, metres (of a single camera: units of its own)\n"
            "v 0.000000 0.000000 0.000000\nv 1.000000 0.000000 0.000000\n"
            "v 0.000000 2.000000 0.000000\nv 0.000000 0.000000 3.000000\n"
            "l 1 2\nl 3 4\n");
}

using testing::HasSubstr;

// A DXF file is pairs of lines: a group code, a value.
struct Group {
  int code;
  std::string value;
};

std::vector<Group> ReadGroups(const std::string& text) {
  std::vector<Group> groups;
  std::istringstream in(text);
  std::string code, value;
  while (std::getline(in, code) && std::getline(in, value)) {
    groups.push_back({std::stoi(code), value});
  }
  return groups;
}

TEST(WriteDxfLines, WritesALineEntityForEachSegment) {
  const ScratchFolder folder;
  const std::vector<Segment3> segments = {{{1, -2, 0.5}, {3, 0, -1e-9}}, {{0, 2, 0}, {0, 0, 3}}};
  WriteDxfLines(folder / "l.dxf", segments);
  const std::string text = Contents(folder / "l.dxf");
  EXPECT_THAT(text, HasSubstr("9\n$ACADVER\n1\nAC1009\n"));
  EXPECT_THAT(text,
              HasSubstr("9\n$EXTMIN\n10\n0.000000\n20\n-2.000000\n30\n0.000000\n"
                        "9\n$EXTMAX\n10\n3.000000\n20\n2.000000\n30\n3.000000\n"));
  EXPECT_THAT(text,
              HasSubstr("0\nLINE\n8\nPLUMBLINE_LINES\n10\n1.000000\n20\n-2.000000\n30\n0.500000\n"
                        "11\n3.000000\n21\n0.000000\n31\n0.000000\n0\nLINE\n"));
  EXPECT_TRUE(text.ends_with("0\nENDSEC\n0\nEOF\n"));
}

TEST(WriteDxfLines, ClosesAllThatItOpens) {
  const ScratchFolder folder;
  for (const std::size_t count : {0U, 3U}) {
    const std::vector<Segment3> segments(count, {{0, 0, 0}, {1, 1, 1}});
    WriteDxfLines(folder / "l.dxf", segments);
    int sections = 0, tables = 0;
    std::size_t lines = 0;
    for (const Group& group : ReadGroups(Contents(folder / "l.dxf"))) {
      if (group.code != 0) continue;
      sections += (group.value == "SECTION") - (group.value == "ENDSEC");
      tables += (group.value == "TABLE") - (group.value == "ENDTAB");
      lines += group.value == "LINE";
      EXPECT_GE(sections, 0);
      EXPECT_LE(sections, 1);
    }
    EXPECT_EQ(sections, 0);
    EXPECT_EQ(tables, 0);
    EXPECT_EQ(lines, count);
  }
}

TEST(WriteDxfLines, FailsWhereThereIsNoFolder) {
  const ScratchFolder folder;
  EXPECT_THROW(WriteDxfLines(folder / "no" / "l.dxf", {}), InputError);
}

}  // namespace

}  // namespace plumbline

// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/ply.h"

#include "tests/io/scratch_folder.h"
#include <string>
#include <vector>

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

}  // namespace
}  // namespace plumbline

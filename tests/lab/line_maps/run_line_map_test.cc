// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/line_maps/run_line_map.h"

#include "plumbline/base/error.h"
#include "plumbline/io/geometry_files.h"

#include "tests/io/scratch_folder.h"
#include "tests/io/write_line_landmark.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

TEST(ReadLineMap, HasTheLandmarksWithTheirOwnEnds) {
  const ScratchFolder folder;
  const Segment3 landmark{{5, 0, 2}, {5.75, 0.5, 2}};
  WriteLineLandmark(folder / "map.plb", landmark);
  const auto lines = ReadLineMap(folder / "map.plb");
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_LT((lines[0].start - landmark.start).norm(), 1e-12);
  EXPECT_LT((lines[0].end - landmark.end).norm(), 1e-12);
}

TEST(ReadLineMap, HasTheSegmentsOfAnObj) {
  const ScratchFolder folder;
  WriteObjLines(folder / "lines.obj", std::vector<Segment3>{{{1, 2, 3}, {4, 5, 6}}});
  const auto lines = ReadLineMap(folder / "lines.obj");
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_EQ(lines[0].end, Eigen::Vector3d(4, 5, 6));
  EXPECT_THROW(ReadLineMap(folder / "lines.dxf"), InputError);
}

}  // namespace
}  // namespace plumbline

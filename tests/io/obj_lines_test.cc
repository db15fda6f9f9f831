// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/export/obj_lines.h"

#include "plumbline/io/geometry_files.h"

#include "tests/io/scratch_folder.h"
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::HasSubstr;

TEST(ReadObjLines, ReadsBackWhatWriteObjLinesWrote) {
  const std::vector<Segment3> written = {{{0, 1, 2}, {3.25, -4, 5}}, {{1, 1, 1}, {1, 1, 1.000001}}};
  const ScratchFolder folder;
  WriteObjLines(folder / "lines.obj", written);
  const std::vector<Segment3> read = ReadObjLines(folder / "lines.obj");
  ASSERT_EQ(read.size(), written.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    EXPECT_LT((read[i].start - written[i].start).norm(), 1e-9);
    EXPECT_LT((read[i].end - written[i].end).norm(), 1e-9);
  }
  WriteObjLines(folder / "lines.obj", {});
  EXPECT_TRUE(ReadObjLines(folder / "lines.obj").empty());
}

TEST(ReadObjLines, KnowsPolylinesOfOtherPrograms) {
  const ScratchFolder folder;
  const auto file = folder.Write("model.obj",
                                 "# Blender\nmtllib model.mtl\no Curve\n"
                                 "v 1 0 0\nv 2 0 0 1.0\nv 3 0 0 0.5 0.5 0.5\nvt 0 0\nvn 0 0 1\n"
                                 "usemtl none\ns off\nf 1 2 3\nl 1 2 3\ng more\n"
                                 "v 4 0 0\nl -1/1 -2/1\nl 1 1\n");
  const std::vector<Segment3> read = ReadObjLines(file);
  const double expected[][2] = {{1, 2}, {2, 3}, {4, 3}, {1, 1}};
  ASSERT_EQ(read.size(), std::size(expected));
  for (std::size_t i = 0; i < read.size(); ++i) {
    EXPECT_EQ(read[i].start, Eigen::Vector3d(expected[i][0], 0, 0)) << i;
    EXPECT_EQ(read[i].end, Eigen::Vector3d(expected[i][1], 0, 0)) << i;
  }
}

TEST(ReadObjLines, RefusesWhatIsMalformed) {
  struct Case {
    std::string content, message;
  };
  const std::string two = "v 0 0 0\nv 1 0 0\n";
  const std::vector<Case> cases = {
      {"v 1 2\n", "m.obj:1: expected a vertex (v x y z), found 2 numbers"},
      {"v 1 2 3 4 5 6 7 8\n", "m.obj:1: expected a vertex (v x y z), found 8 numbers"},
      {"v 1 2 z\n", "m.obj:1: expected a number in column 4, found 'z'"},
      {"v nan 2 3\n", "m.obj:1: expected a number in column 2, found 'nan'"},
      {two + "l\n", "m.obj:3: expected two vertices or more, found none"},
      {two + "l 1\n", "m.obj:3: expected two vertices or more, found one"},
      {"l 1 2\n" + two, "m.obj:1: expected vertices above the line, found '1'"},
      {two + "l 1 3\n", "m.obj:3: expected a vertex from 1 to 2, found '3'"},
      {two + "l 0 1\n", "m.obj:3: expected a vertex from 1 to 2, found '0'"},
      {two + "l 1 -3\n", "found '-3'"},
      {two + "l 1 x\n", "found 'x'"},
      {two + "l 1 2.5\n", "found '2.5'"},
      {two + "l 1 /2\n", "found '/2'"},
      {two + "l 1 99999999999999999999\n", "found '99999999999999999999'"},
      {two + "line 1 2\n", "m.obj:3: expected a record of OBJ such as v or l, found 'line'"}};
  const ScratchFolder folder;
  for (const Case& c : cases) {
    const auto file = folder.Write("m.obj", c.content);
    EXPECT_THAT(MessageOf([&] { ReadObjLines(file); }), HasSubstr(c.message)) << c.content;
  }
}

}  // namespace
}  // namespace plumbline

// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "worlds/true_world.h"

#include "tests/io/scratch_folder.h"
#include "tests/support/random_geometry.h"
#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace true_world_test {

using testing::HasSubstr;

std::vector<TrueLine> SomeLines() {
  Rng rng(11);
  std::vector<TrueLine> lines;
  for (int i = 0; i < 60; ++i) {
    TrueLine line{{RandomVector<3>(rng, std::pow(10.0, i % 7 - 3)), RandomVector<3>(rng, 5)},
                  static_cast<TrueLineKind>(i % 3),
                  std::vector<FrameRange>{}};
    for (int range = 0; range < i % 4; ++range) {
      line.visible->push_back({10 * range, 10 * range + (i % 2) * 3});
    }
    lines.push_back(line);
  }
  return lines;
}

void ExpectSame(const std::vector<TrueLine>& a, const std::vector<TrueLine>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].segment.start, b[i].segment.start) << i;
    EXPECT_EQ(a[i].segment.end, b[i].segment.end) << i;
    EXPECT_EQ(a[i].kind, b[i].kind) << i;
    EXPECT_EQ(a[i].visible, b[i].visible) << i;
  }
}

TEST(TrueLines, ComeBackToTheLastBit) {
  const ScratchFolder folder;
  std::vector<TrueLine> lines = SomeLines();
  WriteTrueLines(folder / "lines.csv", lines);
  ExpectSame(ReadTrueLines(folder / "lines.csv"), lines);
  for (TrueLine& line : lines) line.visible.reset();
  WriteTrueLines(folder / "lines.csv", lines);
  ExpectSame(ReadTrueLines(folder / "lines.csv"), lines);
  WriteTrueLines(folder / "lines.csv", {});
  EXPECT_TRUE(ReadTrueLines(folder / "lines.csv").empty());
}

TEST(TrueLines, AreWrittenAsDocumented) {
  const ScratchFolder folder;
  const std::vector<TrueLine> lines = {
      {{{0, -0.0, 0.1}, {1, 2, -3.5}}, TrueLineKind::kTexture, {{{0, 17}, {25, 25}, {30, 44}}}},
      {{{1, 0, 0}, {1e-9, 2, 3}}, TrueLineKind::kShadow, std::vector<FrameRange>{}}};
  WriteTrueLines(folder / "lines.csv", lines);
  EXPECT_EQ(Contents(folder / "lines.csv"),
            "#x1 [m],y1 [m],z1 [m],x2 [m],y2 [m],z2 [m],kind,visible\n"
            "0,0,0.1,1,2,-3.5,texture,0-17 25 30-44\n"
            "1,0,0,1e-09,2,3,shadow,\n");
}

TEST(TrueLines, WithoutKindAndFramesAreGeometryThatNobodyTimed) {
  const ScratchFolder folder;
  const auto plain = folder.Write("plain.csv", "#x1 [m],y1,z1,x2,y2,z2\n0,0,0,6.4,0,0\r\n");
  ASSERT_EQ(ReadTrueLines(plain).size(), 1U);
  EXPECT_EQ(ReadTrueLines(plain)[0].kind, TrueLineKind::kGeometry);
  EXPECT_FALSE(ReadTrueLines(plain)[0].visible);
  const auto kinds = folder.Write("kinds.csv", "# header\n0,0,0,6.4,0,0, shadow \n");
  EXPECT_EQ(ReadTrueLines(kinds)[0].kind, TrueLineKind::kShadow);
  EXPECT_FALSE(ReadTrueLines(kinds)[0].visible);
  const auto frames = folder.Write("frames.csv", "# header\n0,0,0,1,0,0,geometry, 3  5-6\t9 \n");
  const std::vector<FrameRange> expected = {{3, 3}, {5, 6}, {9, 9}};
  EXPECT_EQ(ReadTrueLines(frames)[0].visible, expected);
}

TEST(TrueLines, RefuseWhatIsMalformed) {
  struct Case {
    std::string content, message;
  };
  const std::string line = "0,0,0,1,0,0", row = line + ",geometry,";
  const std::vector<Case> cases = {
      {"0,0,0,1,0\n", "l.csv:1: expected 6 to 8 columns (x1,y1,z1,x2,y2,z2,kind,visible), found 5"},
      {row + "1,2\n", "l.csv:1: expected 6 to 8 columns"},
      {"#h\n" + line + "\n" + row + "\n",
       "l.csv:3: expected 6 columns as in the rows above, found 8 columns"},
      {row + "\n" + line + "\n", "l.csv:2: expected 8 columns as in the rows above"},
      {"0,0,0,1,x,0\n", "l.csv:1: expected a number in column 5, found 'x'"},
      {"0,0,0,1,inf,0\n", "l.csv:1: expected a number in column 5, found 'inf'"},
      {"0,0,0,1,,0\n", "l.csv:1: expected a number in column 5, found ''"},
      {"1,2,3,1,2,3\n", "l.csv:1: expected two ends in different places"},
      {line + ",edge\n", "l.csv:1: expected geometry, texture or shadow, found 'edge'"},
      {line + ",\n", "l.csv:1: expected geometry, texture or shadow, found ''"},
      {row + "3-\n", "l.csv:1: expected frames such as 0-17 25 30-44, found '3-'"},
      {row + "-3\n", "found '-3'"},
      {row + "5-3\n", "found '5-3'"},
      {row + "1-2-3\n", "found '1-2-3'"},
      {row + "4 1.5\n", "found '1.5'"},
      {row + "99999999999\n", "found '99999999999'"},
      {row + "0-4 4-9\n", "l.csv:1: expected frames that increase, found '4-9' after frame 4"},
      {row + "7 3\n", "found '3' after frame 7"}};
  const ScratchFolder folder;
  for (const Case& c : cases) {
    const auto file = folder.Write("l.csv", c.content);
    EXPECT_THAT(MessageOf([&] { ReadTrueLines(file); }), HasSubstr(c.message)) << c.content;
  }
  EXPECT_THAT(MessageOf([&] { ReadTrueLines(folder / "none.csv"); }), HasSubstr("no such file"));
  EXPECT_THAT(MessageOf([&] { WriteTrueLines(folder / "a" / "l.csv", {}); }),
              HasSubstr("cannot write"));
}

TEST(TrueLines, AreWrittenWithFramesOfAllOrOfNone) {
  const ScratchFolder folder;
  std::vector<TrueLine> lines = SomeLines();
  lines.back().visible.reset();
  EXPECT_THROW(WriteTrueLines(folder / "lines.csv", lines), BugError);
}

TEST(Surfaces, ComeBackToTheLastBit) {
  Rng rng(2);
  std::vector<Parallelogram> surfaces;
  for (int i = 0; i < 30; ++i) {
    surfaces.push_back({RandomVector<3>(rng), RandomVector<3>(rng), RandomVector<3>(rng)});
  }
  const ScratchFolder folder;
  WriteSurfaces(folder / "surfaces.csv", surfaces);
  EXPECT_THAT(Contents(folder / "surfaces.csv"), testing::StartsWith("#ox [m],oy [m],oz [m],ux"));
  const std::vector<Parallelogram> read = ReadSurfaces(folder / "surfaces.csv");
  ASSERT_EQ(read.size(), surfaces.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    EXPECT_EQ(read[i].origin, surfaces[i].origin);
    EXPECT_EQ(read[i].side_u, surfaces[i].side_u);
    EXPECT_EQ(read[i].side_v, surfaces[i].side_v);
  }
}

TEST(Surfaces, RefuseWhatIsMalformed) {
  struct Case {
    std::string content, message;
  };
  const std::vector<Case> cases = {
      {"0,0,0,1,0,0,0,1\n", "s.csv:1: expected 9 columns (ox,oy,oz,ux,uy,uz,vx,vy,vz), found 8"},
      {"#h\n0,0,0,1,0,0,0,1,0\n0,0,0,1,0,0,0,1,z\n",
       "s.csv:3: expected a number in column 9, found 'z'"},
      {"0,0,0,1,0,0,2,0,0\n", "s.csv:1: expected two sides that span an area"},
      {"0,0,0,0,0,0,0,1,0\n", "s.csv:1: expected two sides that span an area"}};
  const ScratchFolder folder;
  for (const Case& c : cases) {
    const auto file = folder.Write("s.csv", c.content);
    EXPECT_THAT(MessageOf([&] { ReadSurfaces(file); }), HasSubstr(c.message)) << c.content;
  }
}

}  // namespace true_world_test
}  // namespace plumbline

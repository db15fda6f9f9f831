// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/cameras/yaml_section.h"

#include "tests/io/scratch_folder.h"
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace yaml_section_test {

using testing::HasSubstr;

YamlSection Parse(const std::string& text) { return YamlSection::Parse(text, "f.yaml"); }

TEST(YamlSection, ReadsWhatOpenCvWrites) {
  const YamlSection root = Parse(
      "%YAML:1.0\n---\nCamera.fx:458.5\nm: !!opencv-matrix\n   rows: 1\n   cols: 2\n"
      "   data:[1,\n     2]\n");
  EXPECT_EQ(root.Number("Camera.fx"), 458.5);
  EXPECT_EQ(root.Matrix("m", 1, 2), Eigen::RowVector2d(1, 2));
  EXPECT_EQ(MessageOf([&] { root.Bool("Camera.fx"); }),
            "f.yaml:3: Camera.fx: expected true or false, found 458.5");
}

TEST(YamlSection, MatricesComeInThreeForms) {
  const Eigen::Matrix<double, 2, 3> expected{{1, 2, 3}, {4, 5, 6}};
  const YamlSection root = Parse(
      "flat: [1, 2, 3, 4, 5, 6]\nrows:\n- [1, 2, 3]\n- [4, 5, 6]\n"
      "group: {rows: 2, cols: 3, data: [1, 2, 3, 4, 5, 6]}\n");
  for (const char* key : {"flat", "rows", "group"}) {
    EXPECT_EQ(root.Matrix(key, 2, 3), expected) << key;
    EXPECT_THAT(MessageOf([&] { root.Matrix(key, 2, 2); }), HasSubstr("expected")) << key;
  }
}

TEST(YamlSection, RotationsAreCheckedAndMadeExact) {
  const YamlSection root = Parse(
      "good: [0, -1.0001, 0, 1, 0, 0, 0, 0, 1]\nmirror: [1, 0, 0, 0, 1, 0, 0, 0, -1]\n"
      "motion: [1, 0, 0, 5, 0, 1, 0, 6, 0, 0, 1, 7]\n");
  EXPECT_NEAR(root.Rotation("good").norm(), 1, 1e-15);
  EXPECT_EQ(MessageOf([&] { root.Rotation("mirror"); }),
            "f.yaml:2: mirror: expected a rotation matrix");
  EXPECT_EQ(root.Motion("motion", 3).translation, Eigen::Vector3d(5, 6, 7));
}

TEST(YamlSection, NamesKeysAndGroups) {
  const YamlSection root = Parse("a.b: 1\nc:\n  d: x\n");
  EXPECT_TRUE(root.Has("a.b"));
  EXPECT_FALSE(root.Has("a"));
  EXPECT_EQ(MessageOf([&] { root.Child("c").Number("d"); }),
            "f.yaml:3: c.d: expected a number, found 'x'");
  EXPECT_EQ(MessageOf([&] { root.Child("c").RejectUnknown({"dd"}); }),
            "f.yaml:3: unknown key 'c.d'; did you mean 'dd'?");
}

TEST(YamlSection, OtherFilesAreNamed) {
  EXPECT_THAT(MessageOf([] { Parse("- 1\n- 2\n"); }), HasSubstr("f.yaml:1: expected 'key: value'"));
  EXPECT_THAT(MessageOf([] { Parse("a: [1\nb: 2\n"); }),
              HasSubstr("expected YAML, found an error"));
}

}  // namespace yaml_section_test
}  // namespace plumbline

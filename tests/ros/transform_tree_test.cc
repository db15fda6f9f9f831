// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "ros/transform_tree.h"

#include "ros/messages.h"
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline::ros_node {
namespace {

using testing::HasSubstr;

constexpr std::int64_t kSecond = 1'000'000'000;

Rigid3 Moved(double x) { return {Eigen::Quaterniond::Identity(), {x, 0, 0}}; }
Rigid3 Turned() {
  return {Eigen::Quaterniond(Eigen::AngleAxisd(1, Eigen::Vector3d::UnitZ())), {0, 2, 0}};
}

void ExpectNear(const Expected<Rigid3, std::string>& found, const Rigid3& expected) {
  ASSERT_TRUE(found) << found.error();
  EXPECT_NEAR((found->translation - expected.translation).norm(), 0, 1e-12);
  EXPECT_NEAR(found->rotation.angularDistance(expected.rotation), 0, 1e-7);
}

TEST(TransformTree, LeadsOverTheCommonAncestor) {
  TransformTree tree;
  tree.Add({{0, "base", "mast", Turned()}, {0, "/mast", "/camera", Moved(1)}}, true);
  tree.Add({{5, "base", "wheel", Moved(3)}}, false);
  ExpectNear(tree.Find("base", "camera"), Turned() * Moved(1));
  ExpectNear(tree.Find("wheel", "camera"), Inverse(Moved(3)) * Turned() * Moved(1));
  ExpectNear(tree.Find("camera", "base"), Inverse(Turned() * Moved(1)));
  EXPECT_THAT(tree.Find("base", "elsewhere").error(), HasSubstr("no transforms lead"));
}

TEST(TransformTree, InterpolatesAndDoesNotGuess) {
  TransformTree tree;
  tree.Add({{kSecond, "odom", "base", Moved(1)}, {2 * kSecond, "odom", "base", Moved(3)}}, false);
  ExpectNear(tree.Find("odom", "base", kSecond + kSecond / 4), Moved(1.5));
  ExpectNear(tree.Find("odom", "base"), Moved(3));
  EXPECT_THAT(tree.Find("odom", "base", 3 * kSecond).error(), HasSubstr("at that time"));
  tree.Add({{20 * kSecond, "odom", "base", Moved(9)}}, false);
  EXPECT_FALSE(tree.Find("odom", "base", kSecond)) << "older than ten seconds";
}

TEST(TransformTree, EndsInACircle) {
  TransformTree tree;
  tree.Add({{0, "a", "b", Moved(1)}, {0, "b", "a", Moved(1)}}, true);
  EXPECT_THAT(tree.Find("c", "a").error(), HasSubstr("a circle"));
}

// Both forms, as they are written and read again.
TEST(TransformsMessage, IsReadAsItIsWritten) {
  for (const bool cdr : {false, true}) {
    // ROS 1 has no times before 1970.
    const std::vector<TransformMessage> sent = {{cdr ? -1 : 1, "map", "odom", Turned()},
                                                {7 * kSecond + 5, "odom", "base_link", Moved(2)}};
    Bytes bytes = TransformsMessage(cdr, sent);
    const auto read = ParseRosTransforms(cdr, bytes);
    ASSERT_TRUE(read);
    ASSERT_EQ(read->size(), sent.size());
    for (std::size_t i = 0; i < sent.size(); ++i) {
      EXPECT_EQ((*read)[i].stamp_ns, sent[i].stamp_ns);
      EXPECT_EQ((*read)[i].parent, sent[i].parent);
      EXPECT_EQ((*read)[i].child, sent[i].child);
      ExpectNear((*read)[i].parent_from_child, sent[i].parent_from_child);
    }
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      EXPECT_FALSE(ParseRosTransforms(cdr, std::span(bytes).first(size))) << size;
    }
    bytes[cdr ? 4 : 0] = 0xff;
    bytes[cdr ? 7 : 3] = 0x7f;
    EXPECT_FALSE(ParseRosTransforms(cdr, bytes)) << "2^31 transforms";
  }
}

}  // namespace
}  // namespace plumbline::ros_node

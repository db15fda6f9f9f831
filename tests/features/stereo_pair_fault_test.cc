// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/random.h"
#include "plumbline/features/stereo_pair_check.h"

#include "tests/features/stereo_pair_scene.h"
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace stereo_pair_fault_test {

using Fault = StereoPairFault;
using testing::EndsWith;
using testing::HasSubstr;

// What becomes of a match that fits: the right point lies at the left one minus its disparity.
using Change = std::function<void(StereoPairMatch&)>;

StereoPairSample SampleOf(std::uint64_t seed, int count, const Change& change) {
  Rng rng(seed, "stereo pair sample");
  StereoPairSample sample;
  sample.left_points = static_cast<std::size_t>(count);
  sample.difference = 1;
  for (int i = 0; i < count; ++i) {
    StereoPairMatch match;
    match.left_index = static_cast<std::size_t>(i);
    match.left = {rng.Uniform(60, 470), rng.Uniform(10, 310)};
    match.right = match.left - Eigen::Vector2d(rng.Uniform(5, 50), rng.Uniform(-0.3, 0.3));
    change(match);
    sample.own.push_back(match);
  }
  return sample;
}

std::vector<StereoPairSample> Samples(int count, const Change& change) {
  std::vector<StereoPairSample> samples;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) samples.push_back(SampleOf(seed, count, change));
  return samples;
}

TEST(StereoPairFault, NeedsManyMatches) {
  const Rectifier rectifier(StereoPairScene::Cameras());
  const Change swap = [](StereoPairMatch& match) { std::swap(match.left, match.right); };
  EXPECT_EQ(FindStereoPairFault(rectifier, Samples(40, swap)), Fault::kSidesSwapped);
  EXPECT_EQ(FindStereoPairFault(rectifier, Samples(10, swap)), std::nullopt);
  EXPECT_EQ(FindStereoPairFault(rectifier, {}), std::nullopt);
}

// Each sample must speak for the fault, and none against it.
TEST(StereoPairFault, IsNotThatOfSomeOfTheSamples) {
  const Rectifier rectifier(StereoPairScene::Cameras());
  auto samples = Samples(80, [](StereoPairMatch& match) { std::swap(match.left, match.right); });
  samples.push_back(SampleOf(9, 20, [](StereoPairMatch&) {}));
  EXPECT_EQ(FindStereoPairFault(rectifier, samples), std::nullopt);
  samples.pop_back();
  EXPECT_EQ(FindStereoPairFault(rectifier, samples), Fault::kSidesSwapped);
}

// Nine of ten points are too far away to have a disparity.
TEST(StereoPairFault, IsFoundByThePointsThatAreNear) {
  const Rectifier rectifier(StereoPairScene::Cameras());
  const auto swapped = Samples(200, [](StereoPairMatch& match) {
    if (match.left_index % 10 != 0) match.right.x() = match.left.x();
    std::swap(match.left, match.right);
  });
  EXPECT_EQ(FindStereoPairFault(rectifier, swapped), Fault::kSidesSwapped);
  const auto right = Samples(200, [](StereoPairMatch& match) {
    if (match.left_index % 10 != 0) match.right.x() = match.left.x();
  });
  EXPECT_EQ(FindStereoPairFault(rectifier, right), std::nullopt);
}

// All is far away, and a camera is turned by less than a degree against its calibration.
TEST(StereoPairFault, OfTheSidesIsNotAnErrorOfTheDisparities) {
  const Rectifier rectifier(StereoPairScene::Cameras());
  const auto far = Samples(100, [](StereoPairMatch& match) {
    match.right.x() = match.left.x() + 4 + static_cast<double>(match.left_index % 10) / 10;
  });
  EXPECT_EQ(FindStereoPairFault(rectifier, far), std::nullopt);
}

// The right image belongs to the next frame, where a wrong calibration is as far off its rows as
// the camera moves from frame to frame: these rows fit by chance.
TEST(StereoPairFault, OfTimeIsNotAnErrorOfTheRows) {
  const Rectifier rectifier(StereoPairScene::Cameras());
  auto samples = Samples(100, [](StereoPairMatch& match) { match.right.y() += 4; });
  for (StereoPairSample& sample : samples) {
    sample.after = sample.own;
    for (StereoPairMatch& match : sample.after) match.right.y() -= 4;
  }
  EXPECT_EQ(FindStereoPairFault(rectifier, samples), std::nullopt);
}

TEST(StereoPairFault, CountsWhatFits) {
  const Rectifier rectifier(StereoPairScene::Cameras());
  const auto sample = SampleOf(1, 30, [](StereoPairMatch& match) {
    if (match.left_index < 5) match.right.y() += 9;
    if (match.left_index >= 25) std::swap(match.left, match.right);
  });
  EXPECT_EQ(CountFitting(rectifier, sample), 20U);
}

TEST(StereoPairFault, IsDescribedInASentenceOfItsOwn) {
  std::set<std::string> texts;
  for (int fault = 0; fault <= static_cast<int>(Fault::kOtherCameras); ++fault) {
    const std::string text = Describe(static_cast<Fault>(fault));
    EXPECT_THAT(text, EndsWith("?"));
    EXPECT_TRUE(texts.insert(text).second) << text;
  }
  EXPECT_THAT(Describe(Fault::kRightLate), HasSubstr("of the frame before"));
  EXPECT_EQ(Describe(Fault::kSidesSwapped),
            "the right images fit as left ones: are the sides swapped?");
}

}  // namespace stereo_pair_fault_test
}  // namespace plumbline

// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/starts/sequence_truth.h"

#include "plumbline/io/datasets/open_dataset.h"
#include "plumbline/io/export/png.h"

#include "tests/e2e/poster_sequence.h"
#include "tests/io/scratch_folder.h"
#include <string>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

struct Opened {
  explicit Opened(const std::filesystem::path& path)
      : mono(OpenDataset(path, {.sensor = SensorKind::kMono})),
        rectifier(mono->calibration()),
        truth(*mono, rectifier, std::nullopt) {}
  std::unique_ptr<Dataset> mono;
  Rectifier rectifier;
  SequenceTruth truth;
};

TEST(SequenceTruth, TakesPosesAndStereoDepth) {
  const ScratchFolder folder;
  const Opened opened(WritePosterSequence(folder, 14));
  EXPECT_TRUE(opened.truth.has_poses());
  const auto pose = opened.truth.WorldFromCamera(4);
  ASSERT_TRUE(pose);
  EXPECT_NEAR(pose->translation.x(), 4 * MovingPoster::kStep, 1e-9);
  EXPECT_FALSE(opened.truth.WorldFromCamera(13)) << "behind the ground truth";
  ASSERT_TRUE(opened.truth.has_depth());
  const auto depth = opened.truth.DepthAt(4);
  ASSERT_TRUE(depth);
  const auto samples = depth->Samples();
  ASSERT_GT(samples.size(), 200U);
  std::size_t near = 0;
  for (const Eigen::Vector3d& point : samples) {
    const auto known = depth->PointAt(opened.rectifier.camera().Project(point));
    near += known && std::abs(known->z() - MovingPoster::kDepth) < 0.05 * MovingPoster::kDepth;
  }
  EXPECT_GT(near, samples.size() * 9 / 10);
}

TEST(SequenceTruth, TakesOtherPosesInPlaceOfTheGroundTruth) {
  const ScratchFolder folder;
  const Opened opened(WritePosterSequence(folder, 12));
  const Trajectory poses = {{MovingPoster::StampNs(2), {ExpSo3({0, 0, 1}), {5, 6, 7}}}};
  const SequenceTruth truth(*opened.mono, opened.rectifier, std::nullopt, poses);
  EXPECT_FALSE(truth.WorldFromCamera(1));
  ASSERT_TRUE(truth.WorldFromCamera(2));
  EXPECT_EQ(truth.WorldFromCamera(2)->translation, Eigen::Vector3d(5, 6, 7));
  EXPECT_NEAR(AngularDistance(truth.WorldFromCamera(2)->rotation, ExpSo3({0, 0, 1})), 0, 1e-12);
}

// `run` and `evaluate` interpolate the ground truth of data in EuRoC's form over gaps of at most
// 0.1 s (ErrorOptionsFor), and the poses of a start are found in the truth by that limit, too.
TEST(SequenceTruth, FindsPosesOverGapsThatAreUsualInItsData) {
  const ScratchFolder folder;
  const Opened opened(WritePosterSequence(folder, 12));
  Trajectory poses;
  for (const int frame : {2, 4, 7}) poses.push_back({MovingPoster::StampNs(frame), {}});
  const SequenceTruth truth(*opened.mono, opened.rectifier, std::nullopt, poses);
  EXPECT_TRUE(truth.WorldFromCamera(3)) << "a gap of 0.1 s";
  EXPECT_FALSE(truth.WorldFromCamera(5)) << "a gap of 0.15 s";
}

TEST(SequenceTruth, PrefersTheDepthImagesOfARenderedWorld) {
  const ScratchFolder folder;
  const auto path = WritePosterSequence(folder, 12);
  folder.Write("sequence/mav0/depth0/sensor.yaml", "sensor_type: depth\ndepth_factor: 5000\n");
  folder.Write("sequence/mav0/depth0/data.csv",
               "#stamp,file\n1000000000,a.png\n1050000000,b.png\n");
  folder.Write("sequence/mav0/depth0/data/a.png", "");
  WriteDepthPng(folder / "sequence/mav0/depth0/data/a.png",
                DepthImage(MovingPoster::kWidth, MovingPoster::kHeight, 1.5F),
                5000);
  const Opened opened(path);
  const auto depth = opened.truth.DepthAt(0);
  ASSERT_TRUE(depth);
  EXPECT_NEAR(depth->PointAt({100, 100})->z(), 1.5, 1e-3);
  EXPECT_FALSE(opened.truth.DepthAt(1)) << "the image is not there";
  EXPECT_FALSE(opened.truth.DepthAt(2)) << "not in the list";
}

TEST(SequenceTruth, KnowsNoDepthOfImagesAlone) {
  const ScratchFolder folder;
  const auto path = WritePosterSequence(folder, 12);
  std::filesystem::remove_all(path / "mav0" / "cam1");
  const Opened opened(path);
  EXPECT_FALSE(opened.truth.has_depth());
  EXPECT_FALSE(opened.truth.DepthAt(0));
  EXPECT_TRUE(opened.truth.WorldFromCamera(0));
}

}  // namespace
}  // namespace plumbline

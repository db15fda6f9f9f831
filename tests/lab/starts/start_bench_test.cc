// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/starts/start_bench.h"

#include "plumbline/io/datasets/open_dataset.h"

#include "tests/e2e/poster_sequence.h"
#include "tests/io/scratch_folder.h"
#include <map>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::ElementsAre;

// Waits, and remembers which features it was given.
class Watcher : public Initializer {
 public:
  explicit Watcher(std::map<std::int64_t, std::set<const void*>>& seen) : seen_(seen) {}
  InitializationResult Add(const InitializationFrame& frame) override {
    seen_[frame.id.value].insert(frame.indexed.get());
    EXPECT_EQ(frame.image->width(), MovingPoster::kWidth);
    EXPECT_GT(frame.indexed->features.points.size(), 100U);
    InitializationResult result;
    result.wait = InitializationStatus::kTooFewFrames;
    return result;
  }
  void Reset() override {}

 private:
  std::map<std::int64_t, std::set<const void*>>& seen_;
};

TEST(StartBench, StartsAtEveryFewFramesThatHaveOneBehind) {
  EXPECT_THAT(EveryStart(12, 0, 5), ElementsAre(0, 5, 10));
  EXPECT_THAT(EveryStart(11, 0, 5), ElementsAre(0, 5));
  EXPECT_THAT(EveryStart(12, 3, 4), ElementsAre(3, 7));
  EXPECT_TRUE(EveryStart(1, 0, 5).empty());
}

TEST(StartBench, ATimeOfVideoEndsWithTheSequence) {
  const ScratchFolder folder;
  const auto dataset = OpenDataset(WritePosterSequence(folder, 12), {.sensor = SensorKind::kMono});
  const StartRange range = RangeOf(*dataset, 2, 0.2001, 0.3001);
  EXPECT_EQ(range.begin, 2);
  EXPECT_EQ(range.in_time, 7) << "every 50 ms; 2 and four more";
  EXPECT_EQ(range.end, 9) << "two more";
  EXPECT_EQ(RangeOf(*dataset, 8, 2, 6).end, 12);
  EXPECT_EQ(RangeOf(*dataset, 8, 2, 6).in_time, 12);
  EXPECT_EQ(RangeOf(*dataset, 2, 0.3001, 0.1).end, 9) << "never before the time";
}

TEST(StartBench, MeasuresEachFrameOnce) {
  const ScratchFolder folder;
  const auto path = WritePosterSequence(folder, 12);
  folder.Write("sequence/mav0/cam0/data/5.png", "not an image");
  const auto dataset = OpenDataset(path, {.sensor = SensorKind::kMono});
  StartOptions options;
  options.features.lines = false;
  StartPlan plan;
  plan.frames = {0, 2, 6};
  std::map<std::int64_t, std::set<const void*>> seen;
  const StartResults results =
      RunStarts(*dataset, {}, options, plan, [&](const CameraAndPyramid& m) {
        EXPECT_EQ(m.camera.width, MovingPoster::kWidth);
        return std::make_unique<Watcher>(seen);
      });
  ASSERT_EQ(results.records.size(), 3U);
  EXPECT_EQ(results.records[0].offered, 11) << "all but number 5";
  EXPECT_EQ(results.records[1].offered, 9);
  EXPECT_EQ(results.add_ms.size(), 11U + 9 + 6);
  EXPECT_EQ(seen.size(), 11U);
  for (const auto& [frame, features] : seen) EXPECT_EQ(features.size(), 1U) << frame;
  // 11 steps of 3 cm before a picture 3 m away.
  EXPECT_NEAR(*results.records[0].greatest_parallax_deg, 6, 0.5);
}

TEST(StartBench, EndsWhenToldTo) {
  const ScratchFolder folder;
  const auto dataset = OpenDataset(WritePosterSequence(folder, 12), {.sensor = SensorKind::kMono});
  StartPlan plan;
  plan.frames = {0, 2, 6};
  std::map<std::int64_t, std::set<const void*>> seen;
  const StartResults results = RunStarts(
      *dataset,
      {},
      {},
      plan,
      [&](const CameraAndPyramid&) { return std::make_unique<Watcher>(seen); },
      [](std::size_t done) { return done < 2; });
  EXPECT_EQ(results.records.size(), 2U);
}

}  // namespace
}  // namespace plumbline

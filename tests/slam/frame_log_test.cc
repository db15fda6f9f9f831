// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/slam/frame_log.h"

#include "plumbline/base/error.h"
#include "plumbline/base/random.h"

#include "tests/support/random_geometry.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

FrameRecord ARecord(std::int64_t id, Rng& rng) {
  FrameRecord record;
  record.id = FrameId{id};
  record.stamp_ns = 1'305'031'102'175'304'000 + id;
  record.status = static_cast<FrameStatus>(id % 4);
  record.reason = id % 3 == 0 ? "" : id % 3 == 1 ? "dropped" : "a reason that is longer than most";
  record.map = id % 5 == 0 ? MapId{} : MapId{id % 7};
  record.reference = KeyFrameId{id / 2 - 1};
  record.from_reference = {RandomRigid(rng), 1.5 + static_cast<double>(id)};
  if (id % 2 == 0) record.causal_world_from_camera = RandomRigid(rng);
  if (id % 4 == 0) {
    Matrix6d& covariance = record.causal_covariance.emplace();
    for (int row = 0; row < 6; ++row) {
      for (int column = row; column < 6; ++column) {
        covariance(row, column) = covariance(column, row) = rng.Uniform(-1, 1);
      }
    }
  }
  record.counts = {70'000, 3, 60'000, 2};
  record.keyframe = id % 2 == 1;
  record.shed = static_cast<LoadLevel>(id % 5);
  record.demoted = id % 7 == 0;
  for (std::int64_t k = 0; k < id % 4; ++k) {
    record.times.push_back({k % 2 == 0 ? "track" : "map_take_in", 0.25 * static_cast<double>(k)});
  }
  return record;
}

void ExpectSame(const FrameRecord& a, const FrameRecord& b) {
  EXPECT_EQ(a.id, b.id);
  EXPECT_EQ(a.stamp_ns, b.stamp_ns);
  EXPECT_EQ(a.status, b.status);
  EXPECT_EQ(a.reason, b.reason);
  EXPECT_EQ(a.map, b.map);
  EXPECT_EQ(a.reference, b.reference);
  EXPECT_EQ(a.from_reference.cam_from_keyframe.Matrix(),
            b.from_reference.cam_from_keyframe.Matrix());
  EXPECT_EQ(a.from_reference.scale, b.from_reference.scale);
  ASSERT_EQ(a.causal_world_from_camera.has_value(), b.causal_world_from_camera.has_value());
  if (a.causal_world_from_camera) {
    EXPECT_EQ(a.causal_world_from_camera->Matrix(), b.causal_world_from_camera->Matrix());
  }
  EXPECT_EQ(a.causal_covariance, b.causal_covariance);
  EXPECT_EQ(a.counts.matched_points, b.counts.matched_points);
  EXPECT_EQ(a.counts.matched_lines, b.counts.matched_lines);
  EXPECT_EQ(a.counts.inlier_points, b.counts.inlier_points);
  EXPECT_EQ(a.counts.inlier_lines, b.counts.inlier_lines);
  EXPECT_EQ(a.keyframe, b.keyframe);
  EXPECT_EQ(a.shed, b.shed);
  EXPECT_EQ(a.demoted, b.demoted);
  ASSERT_EQ(a.times.size(), b.times.size());
  for (std::size_t i = 0; i < a.times.size(); ++i) {
    EXPECT_EQ(a.times[i].stage, b.times[i].stage);
    EXPECT_EQ(a.times[i].milliseconds, b.times[i].milliseconds);
  }
}

std::vector<FrameRecord> Records(std::int64_t count) {
  Rng rng(3);
  std::vector<FrameRecord> records;
  for (std::int64_t i = 0; i < count; ++i) records.push_back(ARecord(i, rng));
  return records;
}

FrameLog LogOf(const std::vector<FrameRecord>& records) {
  FrameLog log;
  for (const FrameRecord& record : records) log.Add(record);
  return log;
}

TEST(FrameLog, RecordsComeOutAsTheyWentIn) {
  const std::vector<FrameRecord> records = Records(2500);
  const FrameLog log = LogOf(records);
  ASSERT_EQ(log.size(), records.size());
  std::size_t i = 0;
  for (const FrameRecord& record : log) ExpectSame(record, records[i++]);
  EXPECT_EQ(i, records.size());
  ExpectSame(log.back(), records.back());
  EXPECT_EQ(log.StampOf(1700), records[1700].stamp_ns);
  EXPECT_EQ(log.ReferenceOf(1700), records[1700].reference);
  EXPECT_EQ(log.StatusOf(1700), records[1700].status);
}

TEST(FrameLog, ARecordCanBeChangedButForItsTimes) {
  std::vector<FrameRecord> records = Records(20);
  FrameLog log = LogOf(records);
  const auto change = [](FrameRecord& record) {
    record.reason = "not_mapped";
    record.reference = KeyFrameId{77};
    record.causal_world_from_camera.reset();
  };
  log.Change(7, change);
  change(records[7]);
  // Covariances come, go and change.
  const auto learn = [](FrameRecord& record) { record.causal_covariance = Matrix6d::Identity(); };
  const auto forget = [](FrameRecord& record) { record.causal_covariance.reset(); };
  for (const std::size_t frame : {3U, 8U}) {
    log.Change(frame, learn);
    learn(records[frame]);
  }
  log.Change(12, forget);
  forget(records[12]);
  log.AddTimes({{"map_finish", 4}});
  records.back().times.push_back({"map_finish", 4});
  for (std::size_t i = 0; i < records.size(); ++i) ExpectSame(log[i], records[i]);
}

TEST(FrameLog, TakesNothingOutOfOrder) {
  FrameLog log = LogOf(Records(3));
  Rng rng(1);
  EXPECT_TRUE(log.Takes(ARecord(3, rng)));
  EXPECT_FALSE(log.Takes(ARecord(4, rng)));
  EXPECT_THROW(log.Add(ARecord(2, rng)), BugError);
  FrameRecord wordy = ARecord(3, rng);
  for (int k = 0; k < 300; ++k) wordy.times.push_back({"stage " + std::to_string(k), 1});
  EXPECT_FALSE(log.Takes(wordy));
}

TEST(FrameLog, AnHourTakesLessThan45Megabytes) {
  constexpr std::int64_t kFrames = 30 * 3600;
  FrameLog log;
  FrameRecord record;
  record.causal_covariance = Matrix6d::Identity();
  for (int k = 0; k < 10; ++k) record.times.push_back({"stage_" + std::to_string(k), 1});
  for (std::int64_t i = 0; i < kFrames; ++i) {
    record.id = FrameId{i};
    log.Add(record);
  }
  EXPECT_LT(log.Memory(), 45'000'000U);
}

}  // namespace
}  // namespace plumbline

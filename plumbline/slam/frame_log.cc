// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/slam/frame_log.h"

#include "plumbline/base/error.h"

#include <algorithm>
#include <limits>
#include <optional>

namespace plumbline {
namespace {

constexpr std::size_t kMostStages = std::size_t{std::numeric_limits<std::uint8_t>::max()} + 1;
constexpr std::size_t kMostReasons = std::size_t{std::numeric_limits<std::uint16_t>::max()} + 1;

}  // namespace

std::size_t WordTable::NumberOf(const std::string& word) {
  const auto known = std::find(words_.begin(), words_.end(), word);
  if (known != words_.end()) return static_cast<std::size_t>(known - words_.begin());
  words_.push_back(word);
  return words_.size() - 1;
}

bool WordTable::Contains(const std::string& word) const {
  return std::find(words_.begin(), words_.end(), word) != words_.end();
}

FrameLog::FrameLog(std::initializer_list<FrameRecord> records) {
  for (const FrameRecord& record : records) Add(record);
}

bool FrameLog::Takes(const FrameRecord& record) const {
  if (record.id.value != static_cast<std::int64_t>(size())) return false;
  if (record.map.value > std::numeric_limits<std::int32_t>::max()) return false;
  if (reasons_.size() >= kMostReasons && !reasons_.Contains(record.reason)) return false;
  std::size_t stages = stage_names_.size();
  for (const StageTime& time : record.times) stages += !stage_names_.Contains(time.stage);
  return stages <= kMostStages;
}

void FrameLog::Add(const FrameRecord& record) {
  PLUMBLINE_CHECK(Takes(record), "a frame record out of order");
  Compact entry;
  entry.first_time = static_cast<std::uint32_t>(milliseconds_.size());
  Store(record, entry);
  entries_.Add(entry);
  AddTimes(record.times);
}

void FrameLog::Change(std::size_t frame, const std::function<void(FrameRecord&)>& change) {
  FrameRecord record = (*this)[frame];
  change(record);
  Store(record, entries_[frame]);
}

void FrameLog::AddTimes(const std::vector<StageTime>& times) {
  for (const StageTime& time : times) {
    stages_.Add(static_cast<std::uint8_t>(stage_names_.NumberOf(time.stage)));
    milliseconds_.Add(static_cast<float>(time.milliseconds));
  }
}

FrameLog::Numbers FrameLog::NumbersOf(const Rigid3& pose) {
  const Eigen::Vector4d& q = pose.rotation.coeffs();
  const Eigen::Vector3d& t = pose.translation;
  return {q[0], q[1], q[2], q[3], t[0], t[1], t[2]};
}

Rigid3 FrameLog::PoseOf(const Numbers& n) {
  Rigid3 pose;
  pose.rotation.coeffs() << n[0], n[1], n[2], n[3];
  pose.translation << n[4], n[5], n[6];
  return pose;
}

FrameLog::Triangle FrameLog::TriangleOf(const Matrix6d& covariance) {
  Triangle triangle{};
  std::size_t i = 0;
  for (Eigen::Index row = 0; row < 6; ++row) {
    for (Eigen::Index column = row; column < 6; ++column) triangle[i++] = covariance(row, column);
  }
  return triangle;
}

Matrix6d FrameLog::CovarianceOf(const Triangle& triangle) {
  Matrix6d covariance;
  std::size_t i = 0;
  for (Eigen::Index row = 0; row < 6; ++row) {
    for (Eigen::Index column = row; column < 6; ++column) {
      covariance(row, column) = covariance(column, row) = triangle[i++];
    }
  }
  return covariance;
}

void FrameLog::Store(const FrameRecord& record, Compact& entry) {
  entry.stamp_ns = record.stamp_ns;
  entry.from_reference = NumbersOf(record.from_reference.cam_from_keyframe);
  entry.scale = record.from_reference.scale;
  entry.has_causal = record.causal_world_from_camera.has_value();
  if (entry.has_causal) entry.causal = NumbersOf(*record.causal_world_from_camera);
  if (!record.causal_covariance) {
    entry.covariance = -1;
  } else if (entry.covariance < 0) {
    entry.covariance = static_cast<std::int32_t>(covariances_.size());
    covariances_.Add(TriangleOf(*record.causal_covariance));
  } else {
    covariances_[static_cast<std::size_t>(entry.covariance)] =
        TriangleOf(*record.causal_covariance);
  }
  entry.reference = record.reference.value;
  entry.map = static_cast<std::int32_t>(record.map.value);
  const FrameCounts& c = record.counts;
  entry.counts = {c.matched_points, c.matched_lines, c.inlier_points, c.inlier_lines};
  entry.reason = static_cast<std::uint16_t>(reasons_.NumberOf(record.reason));
  entry.status = static_cast<std::uint8_t>(record.status);
  entry.shed = static_cast<std::uint8_t>(record.shed);
  entry.keyframe = record.keyframe;
  entry.demoted = record.demoted;
}

FrameRecord FrameLog::operator[](std::size_t frame) const {
  const Compact& entry = entries_[frame];
  FrameRecord record;
  record.id = FrameId{static_cast<std::int64_t>(frame)};
  record.stamp_ns = entry.stamp_ns;
  record.status = static_cast<FrameStatus>(entry.status);
  record.reason = reasons_[entry.reason];
  record.map = MapId{entry.map};
  record.reference = KeyFrameId{entry.reference};
  record.from_reference = {PoseOf(entry.from_reference), entry.scale};
  if (entry.has_causal) record.causal_world_from_camera = PoseOf(entry.causal);
  if (entry.covariance >= 0) {
    record.causal_covariance =
        CovarianceOf(covariances_[static_cast<std::size_t>(entry.covariance)]);
  }
  record.counts = {entry.counts[0], entry.counts[1], entry.counts[2], entry.counts[3]};
  record.keyframe = entry.keyframe;
  record.shed = static_cast<LoadLevel>(entry.shed);
  record.demoted = entry.demoted;
  const std::size_t end =
      frame + 1 < size() ? entries_[frame + 1].first_time : milliseconds_.size();
  record.times.reserve(end - entry.first_time);
  for (std::size_t i = entry.first_time; i < end; ++i) {
    record.times.push_back({stage_names_[stages_[i]], milliseconds_[i]});
  }
  return record;
}

std::size_t FrameLog::Memory() const {
  return entries_.Memory() + covariances_.Memory() + stages_.Memory() + milliseconds_.Memory();
}

}  // namespace plumbline

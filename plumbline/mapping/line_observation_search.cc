// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/mapping/line_observation_search.h"

#include "plumbline/base/elementary.h"
#include "plumbline/base/statistics.h"
#include "plumbline/geometry/segment.h"
#include "plumbline/geometry/triangulation.h"
#include "plumbline/matching/measurements.h"
#include "plumbline/optimization/residuals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/LU>

namespace plumbline {
namespace {

// Deviation that the error of a keyframe's pose adds to that of a segment.
constexpr double kPoseUncertaintyPx = 0.3;
constexpr double kMinOverlap = 0.25;

// Returns true if both ends of a measured segment are near the projected line: 99 % of chi2 with
// two degrees of freedom.
bool Agrees(const RectifiedCamera& camera,
            const Rigid3& cam_from_world,
            const UncertainLine& line,
            LineMeasurement measurement) {
  measurement.covariance += kPoseUncertaintyPx * kPoseUncertaintyPx * Eigen::Matrix2d::Identity();
  AddLandmarkUncertainty(camera, cam_from_world, line, LineWeighting::kCovariance, measurement);
  // Far from the origin the information of a line may be lost in rounding errors.
  if (!IsPositiveDefinite(measurement.covariance)) return false;
  const auto distances = LineDistances(camera, cam_from_world, line.prepared, measurement);
  return distances && distances->squaredNorm() <= kChi2TwoDof99;
}

// Returns the interval of a line shown by a segment; nullopt if the segment runs against the
// direction of the line.
std::optional<LineInterval> Trimmed(const RectifiedCamera& camera,
                                    const PluckerLine& line,
                                    const Frame& frame,
                                    std::size_t feature) {
  const auto interval =
      TrimToSegment(camera, frame.cam_from_world, line, frame.features().lines[feature].segment);
  if (!interval || !(interval->end > interval->start)) return std::nullopt;
  return interval;
}

constexpr double kLoosePx = 10;

// A quick test before the exact one: a segment must be near the projected line and nearly parallel
// to it.
class LooseTest {
 public:
  explicit LooseTest(const Segment2& projected)
      : line_(LineThrough(projected)), direction_(projected.Direction()) {}

  const Eigen::Vector2d& direction() const { return direction_; }

  bool MayShow(const Segment2& segment) const {
    constexpr double kMinCosine = 0.95;  // the cosine that SegmentIndex takes, too
    return std::abs(LineDistance(line_, segment.start)) <= kLoosePx &&
           std::abs(LineDistance(line_, segment.end)) <= kLoosePx &&
           segment.Direction().dot(direction_) >= kMinCosine;
  }

 private:
  Eigen::Vector3d line_;
  Eigen::Vector2d direction_;
};

// Returns the box in which segments are searched before they are tested: the image of the line,
// with a margin. A segment that overlaps the line has a point no further from it than MayShow
// allows; one pixel more allows for rounding. The box is the whole image if the line passes the
// camera.
Eigen::AlignedBox2d Surroundings(const RectifiedCamera& camera, const Segment3& in_camera) {
  constexpr double kNear = 1e-3, kMargin = kLoosePx + 1;
  const double most = std::numeric_limits<double>::max();
  if (!(in_camera.start.z() > kNear) || !(in_camera.end.z() > kNear)) {
    return {Eigen::Vector2d(-most, -most), Eigen::Vector2d(most, most)};
  }
  Eigen::AlignedBox2d box(camera.Project(in_camera.start));
  box.extend(camera.Project(in_camera.end));
  const Eigen::Vector2d margin(kMargin, kMargin);
  return {box.min() - margin, box.max() + margin};
}

}  // namespace

LineSupportSearch::LineSupportSearch(const Map& map, const CameraAndPyramid& imaging)
    : imaging_(imaging), views_(map, imaging.camera) {
  for (std::size_t k = 0; k < views_.size(); ++k) {
    const auto& lines = views_.keyframe(static_cast<int>(k)).frame.features().lines;
    segments_.emplace_back(imaging.camera.width, imaging.camera.height, lines.size());
    for (std::size_t i = 0; i < lines.size(); ++i) segments_.back().Add(i, lines[i].segment);
  }
}

std::vector<LineSupport> LineSupportSearch::Find(const LineHypothesis& hypothesis) const {
  constexpr double kMinLengthPx = 5;
  const Segment3 segment = SegmentOf(hypothesis.line, hypothesis.interval);
  const UncertainLine uncertain(hypothesis.line, hypothesis.information);
  std::vector<LineSupport> supports;
  for (const int index : views_.MayShow(segment, kMinLengthPx, hypothesis.reach)) {
    const KeyFrame& keyframe = views_.keyframe(index);
    const Rigid3& pose = keyframe.frame.cam_from_world;
    const Segment3 in_camera{pose * segment.start, pose * segment.end};
    const auto projected = ProjectSegment(imaging_.camera, in_camera);
    if (!projected || !(projected->Length() > kMinLengthPx)) continue;
    const LooseTest test(*projected);
    const std::vector<LineFeature>& lines = keyframe.frame.features().lines;
    segments_[static_cast<std::size_t>(index)].ForEachNear(
        Surroundings(imaging_.camera, in_camera), test.direction(), [&](std::size_t i) {
          if (!test.MayShow(lines[i].segment)) return;
          const auto support = Test(hypothesis, uncertain, keyframe, i);
          if (support) supports.push_back(*support);
        });
  }
  return supports;
}

void LineSupportSearch::Claim(std::span<const LineSupport> supports) {
  for (const LineSupport& support : supports) {
    const int index = views_.IndexOf(support.keyframe->id);
    segments_[static_cast<std::size_t>(index)].Remove(support.feature);
  }
}

std::optional<LineSupport> LineSupportSearch::Test(const LineHypothesis& hypothesis,
                                                   const UncertainLine& uncertain,
                                                   const KeyFrame& keyframe,
                                                   std::size_t feature) const {
  const Frame& frame = keyframe.frame;
  const auto agrees = [&](const LineMeasurement& measurement) {
    return Agrees(imaging_.camera, frame.cam_from_world, uncertain, measurement);
  };
  if (!agrees(MeasureLeftLine(frame.features(), feature, LineWeighting::kCovariance))) {
    return std::nullopt;
  }
  const auto interval = Trimmed(imaging_.camera, hypothesis.line, frame, feature);
  if (!interval || OverlapRatio(*interval, hypothesis.interval) < kMinOverlap) return std::nullopt;
  const auto right = MeasureRightLine(frame.features(), feature, LineWeighting::kCovariance);
  return LineSupport{&keyframe, feature, right && agrees(*right)};
}

int CountKeyFrames(std::span<const LineSupport> supports) {
  int count = 0;
  const KeyFrame* last = nullptr;
  for (const LineSupport& support : supports) {
    count += support.keyframe != last;
    last = support.keyframe;
  }
  return count;
}

std::optional<LineHypothesis> LineThroughSupports(const RectifiedCamera& camera,
                                                  std::span<const LineSupport> supports) {
  // All supports were tested against the line before, so that no limit on the residual is needed
  // here.
  constexpr double kMinPlaneAngle = 0.002;
  const TriangulationOptions options{.min_angle = kMinPlaneAngle,
                                     .max_residual_sigma = std::numeric_limits<double>::infinity()};
  std::vector<LineView> views;
  for (const LineSupport& support : supports) {
    const Frame& frame = support.keyframe->frame;
    const LineFeature& left = frame.features().lines[support.feature];
    views.push_back(
        {frame.cam_from_world, left.segment, math::Hypot(left.sigma_px, kPoseUncertaintyPx)});
    if (!support.right) continue;
    const MeasuredSegment& right = *frame.features().line_right[support.feature];
    views.push_back({RightCamera(camera, frame.cam_from_world),
                     right.segment,
                     math::Hypot(right.sigma_px, kPoseUncertaintyPx)});
  }
  const auto found = TriangulateLine(camera, views, options);
  if (!found) return std::nullopt;
  LineHypothesis line;
  line.line = found->line;
  line.information = found->covariance.inverse();
  return line;
}

std::vector<LineInterval> ShownParts(const RectifiedCamera& camera,
                                     const PluckerLine& line,
                                     std::span<const LineSupport> supports,
                                     int min_keyframes,
                                     double min_share) {
  constexpr double kMaxGapShare = 0.1;
  std::vector<Stretch> shown, expected;
  for (std::size_t k = 0; k < supports.size();) {
    const KeyFrame& keyframe = *supports[k].keyframe;
    std::vector<Stretch> own;  // overlapping segments of one keyframe count once
    for (; k < supports.size() && supports[k].keyframe == &keyframe; ++k) {
      const auto interval = Trimmed(camera, line, keyframe.frame, supports[k].feature);
      if (interval) own.push_back({interval->start, interval->end});
    }
    for (const Stretch& stretch : CoveredAtLeast(own, 1)) shown.push_back(stretch);
    const auto part = PartInImage(camera, keyframe.frame.cam_from_world, line);
    if (part) expected.push_back(*part);
  }
  const std::vector<Stretch> parts = WellCovered(shown, expected, min_keyframes, min_share);
  if (parts.empty()) return {};
  const double whole = parts.back().to - parts.front().from;
  std::vector<LineInterval> intervals;
  for (const Stretch& part : WithGapsClosed(parts, kMaxGapShare * whole)) {
    if (part.Length() > 0) intervals.push_back({part.from, part.to});
  }
  return intervals;
}

std::optional<Stretch> PartInImage(const RectifiedCamera& camera,
                                   const Rigid3& cam_from_world,
                                   const PluckerLine& line) {
  // Points with n . X >= 0 are on the inner side of a border, and in front of the camera.
  const std::array<Eigen::Vector3d, 5> borders = {
      Eigen::Vector3d(camera.fx, 0, camera.cx),
      Eigen::Vector3d(-camera.fx, 0, camera.width - 1 - camera.cx),
      Eigen::Vector3d(0, camera.fy, camera.cy),
      Eigen::Vector3d(0, -camera.fy, camera.height - 1 - camera.cy),
      Eigen::Vector3d(0, 0, 1)};
  const Eigen::Vector3d foot = cam_from_world * line.Foot();
  const Eigen::Vector3d direction = cam_from_world.rotation * line.direction;
  Stretch part{-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  for (const Eigen::Vector3d& normal : borders) {
    const double at_foot = normal.dot(foot), slope = normal.dot(direction);
    if (slope > 0) {
      part.from = std::max(part.from, -at_foot / slope);
    } else if (slope < 0) {
      part.to = std::min(part.to, -at_foot / slope);
    } else if (at_foot < 0) {
      return std::nullopt;
    }
  }
  if (!(part.to > part.from)) return std::nullopt;
  return part;
}

double OverlapRatio(const LineInterval& a, const LineInterval& b) {
  const double common = std::min(a.end, b.end) - std::max(a.start, b.start);
  return std::max(0.0, common) / std::min(a.end - a.start, b.end - b.start);
}

SegmentIndex::SegmentIndex(int width, int height, std::size_t count)
    : cell_(width / double{kColumns}, height / double{kRows}),
      words_((count + kBits - 1) / kBits),
      cells_(static_cast<std::size_t>(kColumns * kRows) * words_, 0),
      directions_(static_cast<std::size_t>(kDirections) * words_, 0),
      open_(words_, 0) {}

void SegmentIndex::Add(std::size_t index, const Segment2& segment) {
  const std::size_t word = index / kBits;
  Eigen::AlignedBox2d box(segment.start);
  box.extend(segment.end);
  const Range columns = Columns(box), rows = Rows(box);
  for (int row = rows.first; row <= rows.last; ++row) {
    for (int column = columns.first; column <= columns.last; ++column) {
      At(cells_, row * kColumns + column, word) |= Bit(index);
    }
  }
  const Eigen::Vector2d along = segment.end - segment.start;
  At(directions_, DirectionOf(math::Atan2(along.y(), along.x())) % kDirections, word) |= Bit(index);
  At(open_, 0, word) |= Bit(index);
}

// Returns 0 to kDirections for -pi to pi; the last direction is the first one again.
int SegmentIndex::DirectionOf(double angle) {
  const double turns = angle / (2 * std::numbers::pi) + 0.5;
  return std::clamp(static_cast<int>(std::floor(turns * kDirections)), 0, kDirections);
}

SegmentIndex::Range SegmentIndex::DirectionsAround(const Eigen::Vector2d& direction) {
  constexpr double kSpread = 0.32;  // acos(0.95), plus something for rounding
  const double turns = math::Atan2(direction.y(), direction.x()) / (2 * std::numbers::pi) + 0.5;
  const double spread = kSpread / (2 * std::numbers::pi);
  return {static_cast<int>(std::floor((turns - spread) * kDirections)),
          static_cast<int>(std::floor((turns + spread) * kDirections))};
}

// Places outside the image belong to the cells at its border.
SegmentIndex::Range SegmentIndex::Cells(double first, double last, double cell, int count) {
  const auto at = [&](double px) {
    return static_cast<int>(std::clamp(px / cell, 0.0, count - 1.0));
  };
  return {at(first), at(last)};
}

SegmentIndex::Range SegmentIndex::Columns(const Eigen::AlignedBox2d& box) const {
  return Cells(box.min().x(), box.max().x(), cell_.x(), kColumns);
}

SegmentIndex::Range SegmentIndex::Rows(const Eigen::AlignedBox2d& box) const {
  return Cells(box.min().y(), box.max().y(), cell_.y(), kRows);
}

}  // namespace plumbline

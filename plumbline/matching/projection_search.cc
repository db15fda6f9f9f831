// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/matching/projection_search.h"

#include "plumbline/base/elementary.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace plumbline {
namespace {

// Keeps the division by depth finite and has no other meaning: a single camera's map has arbitrary
// scale.
constexpr double kNearPlane = 1e-3;
constexpr double kDisparityGateSigmas = 4;
// Beyond this difference of viewing directions a landmark no longer matches its descriptor.
constexpr double kMaxViewAngleDeg = 60;
// Shorter visible pieces of a line are not found for certain.
constexpr double kMinVisibleLengthPx = 20;

double Radians(double degrees) { return degrees * std::numbers::pi / 180; }

bool SeenFromNear(const Eigen::Vector3d& usual, const Eigen::Vector3d& now) {
  return usual.isZero() || usual.dot(now.normalized()) >= math::Cos(Radians(kMaxViewAngleDeg));
}

// Cuts the parameter interval [lo, hi] to the part where p + t d >= min.
void ClipBelow(double p, double d, double min, double& lo, double& hi) {
  if (std::abs(d) < 1e-12) {
    if (p < min) hi = lo - 1;
    return;
  }
  const double t = (min - p) / d;
  if (d > 0) {
    lo = std::max(lo, t);
  } else {
    hi = std::min(hi, t);
  }
}

// The two nearest descriptors met so far.
struct NearestTwo {
  int best = -1;
  int best_distance = 257;
  int best_octave = -1;
  int second_distance = 257;
  int second_octave = -1;

  void Offer(int index, int distance, int octave) {
    if (distance < best_distance) {
      second_distance = best_distance;
      second_octave = best_octave;
      best = index;
      best_distance = distance;
      best_octave = octave;
    } else if (distance < second_distance) {
      second_distance = distance;
      second_octave = octave;
    }
  }
};

bool DisparityAgrees(const Disparity* measured, double predicted, double slack_px) {
  return measured == nullptr ||
         std::abs(measured->px - predicted) <= slack_px + kDisparityGateSigmas * measured->sigma_px;
}

}  // namespace

std::optional<ProjectedPoint> ProjectPoint(const CameraAndPyramid& imaging,
                                           const Rigid3& cam_from_world,
                                           const PointModel& point) {
  const Eigen::Vector3d p = cam_from_world * point.position;
  if (p.z() < kNearPlane) return std::nullopt;
  const Eigen::Vector2d px = imaging.camera.Project(p);
  if (!imaging.camera.Contains(px)) return std::nullopt;
  const Eigen::Vector3d now = cam_from_world.rotation.conjugate() * p;
  if (!SeenFromNear(point.view_direction, now)) return std::nullopt;
  double octave = point.reference_octave;
  if (point.reference_distance > 0) {
    octave += math::Log(point.reference_distance / p.norm()) / math::Log(imaging.octave_scale);
  }
  const int nearest_octave = std::max(0, static_cast<int>(std::lround(octave)));
  return ProjectedPoint{px,
                        imaging.camera.DisparityFromDepth(p.z()),
                        nearest_octave,
                        math::Pow(imaging.octave_scale, nearest_octave),
                        point.descriptor};
}

std::optional<Segment2> ProjectSegment(const RectifiedCamera& camera, const Segment3& in_camera) {
  double lo = 0;
  double hi = 1;
  const Eigen::Vector3d d = in_camera.end - in_camera.start;
  ClipBelow(in_camera.start.z(), d.z(), kNearPlane, lo, hi);
  if (lo >= hi) return std::nullopt;
  const Eigen::Vector2d a = camera.Project(in_camera.start + lo * d);
  const Eigen::Vector2d b = camera.Project(in_camera.start + hi * d);
  const Eigen::Vector2d ab = b - a;
  lo = 0;
  hi = 1;
  for (int axis = 0; axis < 2; ++axis) {
    const double max = (axis == 0 ? camera.width : camera.height) - 1.0;
    ClipBelow(a(axis), ab(axis), 0, lo, hi);
    ClipBelow(-a(axis), -ab(axis), -max, lo, hi);
  }
  if (lo >= hi) return std::nullopt;
  return Segment2{a + lo * ab, a + hi * ab};
}

std::optional<ProjectedLine> ProjectLine(const CameraAndPyramid& imaging,
                                         const Rigid3& cam_from_world,
                                         const LineModel& line) {
  const Segment3 world = line.Interval();
  const Eigen::Vector3d to_middle = world.Midpoint() - Inverse(cam_from_world).translation;
  if (!SeenFromNear(line.view_direction, to_middle)) return std::nullopt;
  const auto segment =
      ProjectSegment(imaging.camera, {cam_from_world * world.start, cam_from_world * world.end});
  if (!segment || segment->Length() < kMinVisibleLengthPx) return std::nullopt;
  return ProjectedLine{*segment, line.descriptor};
}

std::optional<ProjectionMatch> PointProjectionMatcher::Match(const ProjectedPoint& landmark,
                                                             const std::vector<bool>& taken) {
  const Features& features = image_.features;
  const double radius = options_.point_radius_px * landmark.scale;
  image_.PointsInWindow(landmark.px, {radius, radius}, &near_);
  NearestTwo nearest;
  for (const int index : near_) {
    const auto i = static_cast<std::size_t>(index);
    const PointFeature& feature = features.points[i];
    if (taken[i] || std::abs(feature.octave - landmark.octave) > 1) continue;
    if (!DisparityAgrees(features.point_disparity.Find(i), landmark.disparity, radius)) continue;
    nearest.Offer(index, HammingDistance(feature.descriptor, landmark.descriptor), feature.octave);
  }
  if (nearest.best < 0 || nearest.best_distance > options_.point_max_distance) return std::nullopt;
  if (nearest.best_octave == nearest.second_octave &&
      nearest.best_distance > options_.point_ratio * nearest.second_distance) {
    return std::nullopt;
  }
  return ProjectionMatch{nearest.best, nearest.best_distance};
}

LineProjectionMatcher::LineProjectionMatcher(const FrameFeatures& image,
                                             const ProjectionSearchOptions& options)
    : lines_(image.features.lines),
      options_(options),
      min_cosine_(math::Cos(Radians(options.line_angle_deg))) {
  places_.reserve(lines_.size());
  for (const LineFeature& line : lines_) {
    places_.push_back({line.segment.Direction(), line.segment.Midpoint()});
  }
}

std::optional<ProjectionMatch> LineProjectionMatcher::Match(const ProjectedLine& landmark,
                                                            const std::vector<bool>& taken) const {
  const Segment2& predicted = landmark.segment;
  const Eigen::Vector2d direction = predicted.Direction();
  const Eigen::Vector3d infinite = LineThrough(predicted);
  NearestTwo nearest;
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    if (taken[i] || places_[i].direction.dot(direction) < min_cosine_) continue;
    if (std::abs(LineDistance(infinite, places_[i].midpoint)) > options_.line_offset_px) continue;
    if (OverlapRatio(predicted, lines_[i].segment) < 0.3) continue;
    nearest.Offer(static_cast<int>(i),
                  HammingDistance(lines_[i].descriptor, landmark.descriptor),
                  lines_[i].octave);
  }
  if (nearest.best < 0 || nearest.best_distance > options_.line_max_distance) return std::nullopt;
  return ProjectionMatch{nearest.best, nearest.best_distance};
}

std::vector<LandmarkMatch> OneToOne(const std::vector<std::optional<ProjectionMatch>>& choices,
                                    std::size_t feature_count) {
  std::vector<int> owner(feature_count, -1);
  for (std::size_t i = 0; i < choices.size(); ++i) {
    if (!choices[i]) continue;
    int& current = owner[static_cast<std::size_t>(choices[i]->feature)];
    if (current < 0 ||
        choices[i]->distance < choices[static_cast<std::size_t>(current)]->distance) {
      current = static_cast<int>(i);
    }
  }
  std::vector<LandmarkMatch> matches;
  for (std::size_t i = 0; i < choices.size(); ++i) {
    if (choices[i] && owner[static_cast<std::size_t>(choices[i]->feature)] == static_cast<int>(i)) {
      matches.push_back({static_cast<int>(i), choices[i]->feature});
    }
  }
  return matches;
}

std::vector<LandmarkMatch> MatchProjectedPoints(
    const FrameFeatures& image,
    const std::vector<std::optional<ProjectedPoint>>& landmarks,
    const std::vector<bool>& taken,
    const ProjectionSearchOptions& options) {
  PointProjectionMatcher matcher(image, options);
  std::vector<std::optional<ProjectionMatch>> choices(landmarks.size());
  for (std::size_t l = 0; l < landmarks.size(); ++l) {
    if (landmarks[l]) choices[l] = matcher.Match(*landmarks[l], taken);
  }
  return OneToOne(choices, image.features.points.size());
}

std::vector<LandmarkMatch> MatchProjectedLines(
    const FrameFeatures& image,
    const std::vector<std::optional<ProjectedLine>>& landmarks,
    const std::vector<bool>& taken,
    const ProjectionSearchOptions& options) {
  const LineProjectionMatcher matcher(image, options);
  std::vector<std::optional<ProjectionMatch>> choices(landmarks.size());
  for (std::size_t l = 0; l < landmarks.size(); ++l) {
    if (landmarks[l]) choices[l] = matcher.Match(*landmarks[l], taken);
  }
  return OneToOne(choices, image.features.lines.size());
}

}  // namespace plumbline

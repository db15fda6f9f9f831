// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/random.h"
#include "plumbline/features/grid.h"
#include "plumbline/features/types.h"
#include "plumbline/map/frame.h"
#include "plumbline/matching/projection_search.h"

#include "tests/support/random_geometry.h"
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace plumbline {

// A world of points and straight lines with made-up descriptors, observed without images: the
// features of a frame are the noisy projections of the visible landmarks.
struct SyntheticWorld {
  struct Point {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    Descriptor descriptor{};
  };
  struct Line {
    Segment3 segment;
    Descriptor descriptor{};
  };

  RectifiedCamera camera = TestCamera();
  std::vector<Point> points;
  std::vector<Line> lines;

  CameraAndPyramid Imaging() const { return {camera, 1.2}; }
};

inline Descriptor RandomDescriptor(Rng& rng) {
  return {rng.Next(), rng.Next(), rng.Next(), rng.Next()};
}

// Landmarks in a box of 14 x 7 x 6 m, 3 to 9 m in front of a camera at the origin.
inline SyntheticWorld MakeSyntheticWorld(std::size_t points, std::size_t lines) {
  Rng rng(7, "synthetic_world");
  SyntheticWorld world;
  const auto place = [&] {
    const double x = rng.Uniform(-7, 7);
    const double y = rng.Uniform(-3.5, 3.5);
    return Eigen::Vector3d(x, y, rng.Uniform(3, 9));
  };
  for (std::size_t i = 0; i < points; ++i) world.points.push_back({place(), RandomDescriptor(rng)});
  for (std::size_t i = 0; i < lines; ++i) {
    const Eigen::Vector3d start = place();
    const Eigen::Vector3d direction = RandomVector<3>(rng).normalized();
    world.lines.push_back(
        {{start, start + rng.Uniform(0.6, 2) * direction}, RandomDescriptor(rng)});
  }
  return world;
}

// A gentle walk from the origin with some turning: cam_from_world of frame i, about 2.5 cm and half
// a degree from frame to frame.
inline Rigid3 PoseOnPath(int frame) {
  const double s = 0.03 * frame;
  const Eigen::Vector3d centre(0.8 * std::sin(s), 0.15 * (1 - std::cos(2 * s)), 0.3 * std::sin(s));
  const Eigen::Vector3d turn(0.05 * std::sin(2 * s), 0.2 * std::sin(s), 0.04 * std::sin(1.5 * s));
  return Inverse(Rigid3{ExpSo3(turn), centre});
}

struct SensorModel {
  bool points = true;
  bool lines = true;
  bool depth = true;
  double noise = 1;      // multiplies all measurement errors; the sigmas do not change
  int flipped_bits = 8;  // of a descriptor, at most
  double missed = 0.05;  // share of the landmarks in view that are not detected
};

// The features of a frame, and the landmark of the world of each.
struct SyntheticFrame {
  std::shared_ptr<const FrameFeatures> indexed;
  std::vector<std::size_t> point_truth;
  std::vector<std::size_t> line_truth;
};

namespace synthetic_detail {

inline Descriptor Flipped(Descriptor descriptor, int bits, Rng& rng) {
  for (int i = 0; i < bits; ++i) {
    const std::size_t bit = rng.Index(256);
    descriptor[bit / 64] ^= std::uint64_t{1} << (bit % 64);
  }
  return descriptor;
}

inline void AddPoint(const SyntheticWorld& world,
                     std::size_t index,
                     const Rigid3& cam_from_world,
                     const SensorModel& sensor,
                     Rng& rng,
                     Features& features) {
  const Eigen::Vector3d p = cam_from_world * world.points[index].position;
  PointFeature feature;
  const double exact_octave = std::log(8 / p.norm()) / std::log(1.2);
  feature.octave = static_cast<std::int16_t>(std::clamp(std::lround(exact_octave), 0L, 7L));
  feature.sigma_px = 0.7 * std::pow(1.2, feature.octave);
  feature.px = world.camera.Project(p) + RandomVector<2>(rng, sensor.noise * feature.sigma_px);
  feature.descriptor = Flipped(world.points[index].descriptor, sensor.flipped_bits, rng);
  features.points.push_back(feature);
  std::optional<Disparity> disparity;
  if (sensor.depth) {
    const double sigma = 0.3;
    disparity =
        Disparity{world.camera.DisparityFromDepth(p.z()) + rng.Normal(sensor.noise * sigma), sigma};
  }
  features.point_disparity.push_back(disparity);
}

inline Segment2 Noisy(const Segment2& segment, double sigma, Rng& rng) {
  return {segment.start + RandomVector<2>(rng, sigma), segment.end + RandomVector<2>(rng, sigma)};
}

// Detected pieces lack up to a tenth at each end, differently in each image.
inline Segment3 Shortened(const Segment3& segment, Rng& rng) {
  const Eigen::Vector3d along = segment.end - segment.start;
  return {segment.start + rng.Uniform(0, 0.1) * along, segment.end - rng.Uniform(0, 0.1) * along};
}

inline void AddLine(const SyntheticWorld& world,
                    std::size_t index,
                    const Rigid3& cam_from_world,
                    const SensorModel& sensor,
                    Rng& rng,
                    SyntheticFrame& frame,
                    Features& features) {
  const SyntheticWorld::Line& line = world.lines[index];
  const Segment3 in_left{cam_from_world * line.segment.start, cam_from_world * line.segment.end};
  const auto left = ProjectSegment(world.camera, Shortened(in_left, rng));
  const Eigen::Vector3d shift(world.camera.baseline, 0, 0);
  const auto right =
      ProjectSegment(world.camera, Shortened({in_left.start - shift, in_left.end - shift}, rng));
  if (!left || left->Length() < 25) return;
  LineFeature feature;
  feature.sigma_px = 0.4;
  feature.segment = Noisy(*left, sensor.noise * feature.sigma_px, rng);
  feature.descriptor = Flipped(line.descriptor, sensor.flipped_bits, rng);
  features.lines.push_back(feature);
  std::optional<MeasuredSegment> in_right;
  if (sensor.depth && right && right->Length() >= 25) {
    in_right = MeasuredSegment{Noisy(*right, sensor.noise * 0.4, rng), 0.4};
  }
  features.line_right.push_back(in_right);
  frame.line_truth.push_back(index);
}

}  // namespace synthetic_detail

// Returns the features at a pose. The same rng state gives the same features.
inline SyntheticFrame Sense(const SyntheticWorld& world,
                            const Rigid3& cam_from_world,
                            const SensorModel& sensor,
                            Rng& rng) {
  SyntheticFrame frame;
  Features features;
  for (std::size_t i = 0; sensor.points && i < world.points.size(); ++i) {
    const Eigen::Vector3d p = cam_from_world * world.points[i].position;
    if (p.z() < 0.5 || !world.camera.Contains(world.camera.Project(p), 5)) continue;
    if (rng.Uniform() < sensor.missed) continue;
    synthetic_detail::AddPoint(world, i, cam_from_world, sensor, rng, features);
    frame.point_truth.push_back(i);
  }
  for (std::size_t i = 0; sensor.lines && i < world.lines.size(); ++i) {
    if (rng.Uniform() < sensor.missed) continue;
    synthetic_detail::AddLine(world, i, cam_from_world, sensor, rng, frame, features);
  }
  frame.indexed = IndexFeatures(world.camera, std::move(features));
  return frame;
}

// Makes a frame of the tracker, without matches.
inline Frame MakeFrame(FrameId id, const Rigid3& cam_from_world, const SyntheticFrame& sensed) {
  Frame frame;
  frame.id = id;
  frame.stamp_ns = id.value * 50'000'000;
  frame.cam_from_world = cam_from_world;
  frame.indexed = sensed.indexed;
  frame.points.resize(sensed.point_truth.size());
  frame.lines.resize(sensed.line_truth.size());
  return frame;
}

// Distance of two camera centres, metres.
inline double CentreDistance(const Rigid3& a_cam_from_world, const Rigid3& b_cam_from_world) {
  return (Inverse(a_cam_from_world).translation - Inverse(b_cam_from_world).translation).norm();
}

}  // namespace plumbline

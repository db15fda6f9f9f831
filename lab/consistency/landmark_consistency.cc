// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/consistency/landmark_consistency.h"

#include "lab/consistency/residual_consistency.h"
#include "plumbline/base/elementary.h"
#include "plumbline/base/units.h"
#include "plumbline/geometry/triangulation.h"
#include "plumbline/geometry/trimming.h"
#include "plumbline/matching/measurements.h"
#include "plumbline/optimization/residuals.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <Eigen/LU>

namespace plumbline {
namespace {

constexpr double kNear = 0.05;  // metres, of a surface
constexpr double kNearPx = 2;   // of a true line, seen from the first keyframe
constexpr double kMaxAngle = 2 * kDegree;

// Distance across the nearest surface, over its deviation.
double SurfaceError(const TriangulatedPoint& point, std::span<const Parallelogram> surfaces) {
  double least = std::numeric_limits<double>::infinity();
  double error = least;
  for (const Parallelogram& surface : surfaces) {
    const Eigen::Vector3d normal = surface.side_u.cross(surface.side_v).normalized();
    const double across = std::abs(normal.dot(point.position - surface.origin));
    // The foot is on the surface if no point of it is nearer than its plane.
    if (across >= least || Distance(surface, point.position) > across + 1e-6) continue;
    least = across;
    error = across / std::sqrt(normal.dot(point.covariance * normal));
  }
  return least <= kNear || error <= 5 ? error : std::numeric_limits<double>::infinity();
}

void AddPoints(const Map& map,
               const RectifiedCamera& camera,
               const KeyFramePoses& poses,
               std::span<const Parallelogram> surfaces,
               std::vector<ConsistencySample>& samples) {
  for (const auto& [id, landmark] : map.points()) {
    std::vector<PointView> views;
    for (const auto& [keyframe, feature] : landmark.observations) {
      const auto pose = poses.find(keyframe);
      if (pose == poses.end()) continue;
      const PointMeasurement m =
          MeasurePoint(map.Find(keyframe)->frame.features(), static_cast<std::size_t>(feature));
      views.push_back({pose->second, m.px, m.sigma_px, m.disparity});
    }
    const auto point = TriangulatePoint(camera, views, {.min_angle = 1e-3});
    if (!point) continue;
    ConsistencySample sample;
    sample.kind = ConsistencyKind::kPointLandmark;
    const double error = SurfaceError(*point, surfaces);
    sample.nees = error * error;
    sample.earlier = static_cast<int>(views.size());
    samples.push_back(sample);
  }
}

// Vector from a point to the nearest one of the (infinite) line of a segment.
Eigen::Vector3d ToLine(const Segment3& line, const Eigen::Vector3d& point) {
  const Eigen::Vector3d direction = line.Direction();
  const Eigen::Vector3d offset = line.start - point;
  return offset - direction.dot(offset) * direction;
}

// Returns the true line, in the world of the line, that is nearest to it at the further end.
std::optional<Segment3> Counterpart(const RectifiedCamera& camera,
                                    const SeenLine& seen,
                                    const Segment3& line,
                                    std::span<const TrueLine> truth) {
  const double pixels = kNearPx * line.Midpoint().norm() / camera.fx;  // in metres at the line
  const double sigma = SigmaAt(seen.line, seen.information, seen.line.ParameterOf(line.Midpoint()));
  if (!(sigma <= pixels)) return std::nullopt;
  const Rigid3& first_from_world = seen.first_from_world;
  const double near = pixels + 3 * sigma;
  double least = near;
  std::optional<Segment3> found;
  for (const TrueLine& candidate : truth) {
    const Segment3 other{first_from_world * candidate.segment.start,
                         first_from_world * candidate.segment.end};
    if (UndirectedAngle(line.Direction(), other.Direction()) > kMaxAngle) continue;
    const double middle = Distance(other, line.Midpoint());
    if (middle >= near) continue;
    const double furthest =
        std::max(ToLine(other, line.start).norm(), ToLine(other, line.end).norm());
    if (furthest >= least) continue;
    least = furthest;
    found = other;
  }
  return found;
}

// Error at both ends across the line, in its frame, against its covariance.
double LineError(const SeenLine& seen, const Segment3& ends, const Segment3& truth) {
  const Eigen::Matrix<double, 3, 2> across = BasisAcross(seen.line.direction);
  const OrthonormalLine orthonormal = ToOrthonormal(seen.line);
  Eigen::Vector4d e;
  Eigen::Matrix4d J;
  int row = 0;
  for (const Eigen::Vector3d& end : {ends.start, ends.end}) {
    e.segment<2>(row) = across.transpose() * ToLine(truth, end);
    J.middleRows<2>(row) =
        across.transpose() * ShiftJacobian(seen.line, orthonormal, seen.line.ParameterOf(end));
    row += 2;
  }
  const Eigen::Vector4d tangent = J.fullPivLu().solve(e);
  return tangent.dot(seen.information * tangent);
}

void AddSegments(const RectifiedCamera& camera,
                 const SeenLine& seen,
                 const Segment3& truth,
                 std::vector<ConsistencySample>& samples) {
  const PreparedLine prepared(ToOrthonormal(LineThroughPoints(truth.start, truth.end)));
  for (const SeenSegment& segment : seen.segments) {
    LineMeasurement unit = segment.measurement;
    unit.covariance.setIdentity();
    const auto px = LineDistances(camera, seen.CameraFromFirst(segment), prepared, unit);
    if (!px) continue;
    const bool right = segment.measurement.camera == 1;
    ConsistencySample sample = SampleOf(
        right ? ConsistencyKind::kRightSegment : ConsistencyKind::kSegment, camera, segment);
    const Eigen::Matrix2d& S = segment.measurement.covariance;
    sample.nees = px->dot(S.inverse() * *px);
    sample.dimensions = 2;
    sample.across_px = {0.5 * (px->x() + px->y()), 0.5 * (px->y() - px->x())};
    sample.promised_px = {std::sqrt(0.25 * (S(0, 0) + 2 * S(0, 1) + S(1, 1))),
                          std::sqrt(0.25 * (S(0, 0) - 2 * S(0, 1) + S(1, 1)))};
    samples.push_back(sample);
  }
}

}  // namespace

std::vector<ConsistencySample> LandmarkSamples(const Map& map,
                                               const RectifiedCamera& camera,
                                               const KeyFramePoses& poses,
                                               const TrueSurroundings& truth) {
  std::vector<ConsistencySample> samples;
  if (!truth.surfaces.empty()) AddPoints(map, camera, poses, truth.surfaces, samples);
  for (const auto& [id, line] : map.lines()) {
    const auto seen = SeeLine(map, camera, poses, line);
    if (!seen) continue;
    const SeenSegment& first = seen->segments.front();
    const auto interval = TrimToSegment(camera, Rigid3{}, seen->line, first.measurement.segment);
    if (!interval) continue;
    const Segment3 ends = SegmentOf(seen->line, *interval);
    const auto counterpart = Counterpart(camera, *seen, ends, truth.lines);
    if (!counterpart) continue;
    ConsistencySample sample = SampleOf(ConsistencyKind::kLineLandmark, camera, first);
    sample.nees = LineError(*seen, ends, *counterpart);
    sample.dimensions = 4;
    sample.earlier = seen->segments.back().earlier + 1;
    samples.push_back(sample);
    AddSegments(camera, *seen, *counterpart, samples);
  }
  return samples;
}

}  // namespace plumbline

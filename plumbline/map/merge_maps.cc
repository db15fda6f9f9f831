// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/map/merge_maps.h"

#include <algorithm>
#include <utility>

#include <Eigen/LU>
#include <Eigen/QR>

namespace plumbline {
namespace {

PluckerLine TransformedLine(const Similarity3& b_from_a, const PluckerLine& line) {
  const Eigen::Vector3d direction = b_from_a.rotation * line.direction;
  return {
      b_from_a.scale * (b_from_a.rotation * line.moment) + b_from_a.translation.cross(direction),
      direction};
}

// d(tangent of the line in b) / d(tangent of the line in a). Lines are points of a projective
// space: their homogeneous coordinates (m, d) transform linearly, up to a factor.
Eigen::Matrix4d TangentJacobian(const Similarity3& b_from_a,
                                const PluckerLine& in_a,
                                const PluckerLine& in_b) {
  const OrthonormalLine a = ToOrthonormal(in_a), b = ToOrthonormal(in_b);
  const Eigen::Matrix3d rotation = b_from_a.rotation.toRotationMatrix();
  Matrix6d transform = Matrix6d::Zero();
  transform.topLeftCorner<3, 3>() = b_from_a.scale * rotation;
  transform.topRightCorner<3, 3>() = Skew(b_from_a.translation) * rotation;
  transform.bottomRightCorner<3, 3>() = rotation;
  const Vector6d moved = transform * a.Homogeneous();
  const Vector6d unit = moved.normalized();
  const Matrix6d normalize = (Matrix6d::Identity() - unit * unit.transpose()) / moved.norm();
  return HomogeneousJacobian(b).colPivHouseholderQr().solve(normalize * transform *
                                                            HomogeneousJacobian(a));
}

// What moves by the same similarity stays as it is for a camera among it.
void Move(const Similarity3& b_from_a, KeyFrame& keyframe) {
  Rigid3& cam_from_world = keyframe.frame.cam_from_world;
  cam_from_world = Inverse(TransformPose(b_from_a, Inverse(cam_from_world)));
}

void Move(const Similarity3& b_from_a, PointModel& point) {
  point.position = b_from_a * point.position;
  point.view_direction = b_from_a.rotation * point.view_direction;
  point.reference_distance *= b_from_a.scale;
}

void Move(const Similarity3& b_from_a, LineModel& line) {
  const PluckerLine moved = TransformedLine(b_from_a, line.line);
  line.start = moved.ParameterOf(b_from_a * line.line.PointAt(line.start));
  line.end = moved.ParameterOf(b_from_a * line.line.PointAt(line.end));
  const Eigen::Matrix4d a_from_b = TangentJacobian(b_from_a, line.line, moved).inverse();
  line.information = a_from_b.transpose() * line.information * a_from_b;
  line.view_direction = b_from_a.rotation * line.view_direction;
  line.line = moved;
}

// The ids of the second map behind those of the first.
struct Renumbering {
  std::int64_t keyframes, points, lines;

  KeyFrameId operator()(KeyFrameId id) const { return Behind(id, keyframes); }
  PointId operator()(PointId id) const { return Behind(id, points); }
  LineId operator()(LineId id) const { return Behind(id, lines); }
  Observations operator()(const Observations& observations) const {
    Observations renumbered;
    for (const auto& [keyframe, feature] : observations) {
      renumbered.emplace((*this)(keyframe), feature);
    }
    return renumbered;
  }

 private:
  template <class SomeId>
  static SomeId Behind(SomeId id, std::int64_t first) {
    return id.valid() ? SomeId{id.value + first} : id;
  }
};

template <class Landmark>
void Renumber(const Renumbering& renumbering, Landmark& landmark) {
  landmark.id = renumbering(landmark.id);
  landmark.created_by = renumbering(landmark.created_by);
  landmark.observations = renumbering(landmark.observations);
}

}  // namespace

Map MergeMaps(const Map& first, const Map& second, const Similarity3& first_from_second) {
  const Renumbering renumbering{
      first.NextKeyFrameId().value, first.NextPointId().value, first.NextLineId().value};
  MapEdit edit;
  for (const auto& [id, original] : second.keyframes()) {
    KeyFrame keyframe = original;
    Move(first_from_second, keyframe);
    keyframe.id = renumbering(keyframe.id);
    keyframe.parent = renumbering(keyframe.parent);
    // Matches come with the observations of the landmarks.
    std::fill(keyframe.frame.points.begin(), keyframe.frame.points.end(), PointId{});
    std::fill(keyframe.frame.lines.begin(), keyframe.frame.lines.end(), LineId{});
    edit.emplace_back(edit::AddKeyFrame{std::move(keyframe)});
  }
  for (const auto& [id, original] : second.points()) {
    MapPoint point = original;
    Move(first_from_second, point);
    Renumber(renumbering, point);
    edit.emplace_back(edit::AddPoint{std::move(point)});
  }
  for (const auto& [id, original] : second.lines()) {
    MapLine line = original;
    Move(first_from_second, line);
    Renumber(renumbering, line);
    edit.emplace_back(edit::AddLine{std::move(line)});
  }
  Map merged = first;
  merged.Apply(edit);
  return merged;
}

}  // namespace plumbline

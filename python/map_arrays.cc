// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "map_arrays.h"

#include "plumbline/map/map.h"
#include "plumbline/optimization/residuals.h"
#include "plumbline/tracking/line_cutting.h"

#include <cstddef>
#include <vector>

#include <Eigen/Cholesky>

namespace plumbline::python {
namespace {

// Rows of structured arrays.
struct PointSighting {
  std::int64_t point = 0, keyframe = 0;
  std::int32_t feature = 0, octave = 0;
  double px[2] = {};
  double sigma_px = 0, disparity = 0, disparity_sigma = 0;
};
struct LineSighting {
  std::int64_t line = 0, keyframe = 0;
  std::int32_t feature = 0, octave = 0;
  double start[2] = {};
  double end[2] = {};
  double sigma_px = 0;
};

template <class Entries>
Integers IdsOf(const Entries& entries) {
  std::vector<std::int64_t> ids;
  ids.reserve(entries.size());
  for (const auto& [id, entry] : entries) ids.push_back(id.value);
  return ToArray(ids);
}

template <class Row>
py::array RowsToArray(const std::vector<Row>& rows) {
  return py::array_t<Row>(static_cast<py::ssize_t>(rows.size()), rows.data());
}

// Information of all observations of a point about its position in the world, with exact poses.
Eigen::Matrix3d InformationOf(const PyMap& map, const MapPoint& point) {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  for (const auto& [keyframe, feature] : point.observations) {
    const Frame& frame = map.map->Find(keyframe)->frame;
    const auto index = static_cast<std::size_t>(feature);
    const PointFeature& seen = frame.features().points[index];
    const auto residual =
        EvaluatePoint(map.saved->context.camera,
                      frame.cam_from_world,
                      point.position,
                      {seen.px, seen.sigma_px, frame.features().point_disparity[index]});
    if (residual) information += residual->J_point.transpose() * residual->J_point;
  }
  return information;
}

}  // namespace

Integers PointIds(const PyMap& map) { return IdsOf(map.map->points()); }

Integers LineIds(const PyMap& map) { return IdsOf(map.map->lines()); }

Integers KeyFrameIds(const PyMap& map) { return IdsOf(map.map->keyframes()); }

Doubles Points(const PyMap& map) {
  std::vector<Eigen::Vector3d> points;
  for (const auto& [id, point] : map.map->points()) points.push_back(point.position);
  return ToArray(points);
}

Doubles Lines(const PyMap& map) {
  std::vector<PluckerLine> lines;
  for (const auto& [id, line] : map.map->lines()) lines.push_back(line.line);
  return ToArray(lines);
}

Doubles LineEnds(const PyMap& map) {
  std::vector<Segment3> segments;
  for (const auto& [id, line] : map.map->lines()) segments.push_back(line.Interval());
  return ToArray(segments);
}

Doubles LineInformation(const PyMap& map) {
  Doubles array(
      {static_cast<py::ssize_t>(map.map->lines().size()), py::ssize_t{4}, py::ssize_t{4}});
  double* out = array.mutable_data();
  for (const auto& [id, line] : map.map->lines()) {
    Eigen::Map<Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>{out} = line.information;
    out += 16;
  }
  return array;
}

Doubles PointCovariances(const PyMap& map) {
  Doubles array(
      {static_cast<py::ssize_t>(map.map->points().size()), py::ssize_t{3}, py::ssize_t{3}});
  double* out = array.mutable_data();
  for (const auto& [id, point] : map.map->points()) {
    const Eigen::LLT<Eigen::Matrix3d> information(InformationOf(map, point));
    Eigen::Map<Eigen::Matrix3d> covariance(out);  // symmetric
    out += 9;
    constexpr double kSmallest = 1e-12;  // reciprocal condition number
    if (information.info() == Eigen::Success && information.rcond() > kSmallest) {
      covariance = information.solve(Eigen::Matrix3d::Identity());
    } else {
      covariance.setConstant(kMissing);
    }
  }
  return array;
}

Doubles LineEndCovariances(const PyMap& map) {
  Doubles array({static_cast<py::ssize_t>(map.map->lines().size()),
                 py::ssize_t{2},
                 py::ssize_t{3},
                 py::ssize_t{3}});
  double* out = array.mutable_data();
  for (const auto& [id, line] : map.map->lines()) {
    const EndCovariances ends = CovariancesOfEnds(Rigid3(), line, {line.start, line.end});
    for (const Eigen::Matrix3d& end : {ends.start, ends.end}) {
      Eigen::Map<Eigen::Matrix3d>{out} = end;
      out += 9;
    }
  }
  return array;
}

Integers KeyFrameStamps(const PyMap& map) {
  std::vector<std::int64_t> stamps;
  for (const auto& [id, keyframe] : map.map->keyframes()) stamps.push_back(keyframe.frame.stamp_ns);
  return ToArray(stamps);
}

Doubles KeyFramePoses(const PyMap& map) {
  std::vector<Rigid3> poses;
  for (const auto& [id, keyframe] : map.map->keyframes()) {
    poses.push_back(Inverse(keyframe.frame.cam_from_world));
  }
  return ToArray(poses);
}

py::array PointTracks(const PyMap& map) {
  std::vector<PointSighting> rows;
  for (const auto& [id, point] : map.map->points()) {
    for (const auto& [keyframe, feature] : point.observations) {
      const Features& features = map.map->Find(keyframe)->frame.features();
      const auto index = static_cast<std::size_t>(feature);
      const PointFeature& seen = features.points[index];
      const auto& disparity = features.point_disparity[index];
      rows.push_back({id.value,
                      keyframe.value,
                      feature,
                      seen.octave,
                      {seen.px.x(), seen.px.y()},
                      seen.sigma_px,
                      disparity ? disparity->px : kMissing,
                      disparity ? disparity->sigma_px : kMissing});
    }
  }
  return RowsToArray(rows);
}

py::array LineTracks(const PyMap& map) {
  std::vector<LineSighting> rows;
  for (const auto& [id, line] : map.map->lines()) {
    for (const auto& [keyframe, feature] : line.observations) {
      const LineFeature& seen =
          map.map->Find(keyframe)->frame.features().lines[static_cast<std::size_t>(feature)];
      rows.push_back({id.value,
                      keyframe.value,
                      feature,
                      seen.octave,
                      {seen.segment.start.x(), seen.segment.start.y()},
                      {seen.segment.end.x(), seen.segment.end.y()},
                      seen.sigma_px});
    }
  }
  return RowsToArray(rows);
}

void RegisterTrackTypes() {
  PYBIND11_NUMPY_DTYPE(
      PointSighting, point, keyframe, feature, octave, px, sigma_px, disparity, disparity_sigma);
  PYBIND11_NUMPY_DTYPE(LineSighting, line, keyframe, feature, octave, start, end, sigma_px);
}

}  // namespace plumbline::python

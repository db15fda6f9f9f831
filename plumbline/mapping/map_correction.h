// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/features/feature_correction.h"
#include "plumbline/geometry/sim3.h"
#include "plumbline/map/edit.h"
#include "plumbline/map/map.h"

#include <map>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace plumbline {

// Result of a computation beside mapping: the poses of keyframes, the positions of points, and the
// lens correction of the features. The map may have changed since the computation began;
// RebaseCorrection() applies the result to the current map.
struct MapCorrection {
  struct KeyFramePlace {
    Rigid3 before, after;  // cam_from_world
    double scale = 1;      // lengths around the keyframe, after / before
  };
  struct PointPlace {
    Eigen::Vector3d before = Eigen::Vector3d::Zero();
    Eigen::Vector3d after = Eigen::Vector3d::Zero();
  };
  std::map<KeyFrameId, KeyFramePlace> keyframes;
  std::map<PointId, PointPlace> points;
  std::vector<edit::RemovePointObservation> outliers;
  std::optional<LensCorrection> lens = {};  // new lens correction of the map, if it changed
  bool lens_is_right = false;  // RadialCalibration::is_right; may be true in an empty correction

  bool empty() const { return keyframes.empty(); }
};

// Returns the correction as changes of a map that may have grown, shrunk and been adjusted since.
//
// Every keyframe moves by the similarity of the world that the correction implies for it. Its
// changes since then are kept, relative to the moved world. Later keyframes move with their nearest
// ancestor in the correction, so that old and new parts stay consistent. A landmark moves with the
// newest keyframe that shows it. Keyframes and points without changes since get exactly the
// computed poses and positions. Those of keyframes and points that have left the map are ignored.
MapEdit RebaseCorrection(const MapCorrection& correction, const Map& today);

}  // namespace plumbline

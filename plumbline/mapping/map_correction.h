// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/features/lens_correction.h"
#include "plumbline/geometry/sim3.h"
#include "plumbline/map/edit.h"
#include "plumbline/map/map.h"

#include <map>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace plumbline {

// The result of a computation that ran beside mapping: the places of keyframes and points, and the
// lens correction of the features. The map may have changed since the computation began;
// RebaseCorrection() applies the result to the map as it is now.
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
  std::optional<LensCorrection> lens = {};  // the lens correction of the map, where it is another

  bool empty() const { return keyframes.empty(); }
};

// Returns the correction as changes of a map that may have grown, shrunk and been adjusted since.
//
// Every keyframe takes part in the motion that the correction found for it, a similarity of the
// world. What happened to a keyframe meanwhile stays as it is, seen from the moved world. A
// keyframe that came later moves with the nearest ancestor that the correction knows, so that
// nothing tears between old and new. A landmark moves with the newest keyframe that shows it.
// Keyframes and points that did not change meanwhile get exactly the place that was computed.
// Places of keyframes and points that have left the map are left out.
MapEdit RebaseCorrection(const MapCorrection& correction, const Map& today);

}  // namespace plumbline

// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/consistency/consistency_sample.h"
#include "plumbline/geometry/rectified_camera.h"
#include "plumbline/geometry/segment.h"
#include "plumbline/matching/measurements.h"

#include <optional>
#include <vector>

namespace plumbline {

// A measurement of a line by a keyframe.
struct SeenSegment {
  KeyFrameId keyframe;
  Rigid3 cam_from_world;
  LineMeasurement measurement;
  const LineFeature* feature = nullptr;  // of the left image
  double sigma_px = 0;
  int earlier = 0;  // earlier keyframes with this line
};

// A line triangulated from all its measurements at given poses. The world is the camera of the
// first one, in which the line is well conditioned.
struct SeenLine {
  PluckerLine line;
  Eigen::Matrix4d information = Eigen::Matrix4d::Zero();  // of the orthonormal tangent
  Rigid3 first_from_world;
  std::vector<SeenSegment> segments;  // in the order of time, left before right

  Rigid3 CameraFromFirst(const SeenSegment& segment) const {
    return segment.cam_from_world * Inverse(first_from_world);
  }
};

// Returns the line of a landmark of the map; nullopt if its measurements at these poses give none.
// The measurements weigh as everywhere (MeasureLeftLine).
std::optional<SeenLine> SeeLine(const Map& map,
                                const RectifiedCamera& camera,
                                const KeyFramePoses& poses,
                                const MapLine& line);

// Fills in what is known of a segment besides its error.
ConsistencySample SampleOf(ConsistencyKind kind,
                           const RectifiedCamera& camera,
                           const SeenSegment& segment);

// Returns the errors of all observations of the map's points and lines: each against the landmark
// as its earlier observations give it (normalized innovations). The landmark is triangulated from
// all of them at these poses; the estimate of the earlier ones follows from the linearization
// there. S is the covariance of the measurement plus that of the projected landmark. Where the
// landmark is known to less than twice the measurement, an observation tells nothing and is left
// out.
//
//   poses  those of the truth or of the run; world, rotation and, without a baseline, unit of
//          length do not matter. Keyframes without one are left out.
std::vector<ConsistencySample> ResidualSamples(const Map& map,
                                               const RectifiedCamera& camera,
                                               const KeyFramePoses& poses);

}  // namespace plumbline

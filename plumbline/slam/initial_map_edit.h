// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/ids.h"
#include "plumbline/initialization/initializer.h"
#include "plumbline/map/edit.h"
#include "plumbline/map/map.h"
#include "plumbline/matching/projection_search.h"

#include <vector>

namespace plumbline {

// First edit of a map that begins with several keyframes at once.
struct InitialMapEdit {
  // Adds keyframes, points and lines to an empty map.
  MapEdit edit;
  std::vector<KeyFrameId> keyframes;  // in order of time
  std::vector<FrameId> frames;        // frame of each keyframe
};

// Converts the initial map of a monocular sequence to the first edit of a map. All its views become
// keyframes, numbered from `first` on. Descriptors and information of landmarks come from their
// observations.
//
//   world_from_first_cam  pose of the first view in the world of the map; the initial map's world
//                         is that view's camera
InitialMapEdit MakeInitialMapEdit(const InitialMap& initial,
                                  const CameraAndPyramid& imaging,
                                  const Rigid3& world_from_first_cam,
                                  KeyFrameId first);

// Renumbers the landmarks of an edit for a map that is empty but may follow others in its atlas,
// because landmark ids are unique within an atlas.
MapEdit NumberedFor(const Map& map, MapEdit edit);

}  // namespace plumbline

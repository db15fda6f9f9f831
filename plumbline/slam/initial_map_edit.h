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

// A map that begins with several keyframes at once.
struct InitialMapEdit {
  // Adds keyframes, points and lines to an empty map.
  MapEdit edit;
  std::vector<KeyFrameId> keyframes;  // in order of time
  std::vector<FrameId> frames;        // the frames that the keyframes were made from
};

// Turns the initial map of a monocular sequence into the first edit of a map. All its views become
// keyframes, numbered from `first` on. Landmarks get the descriptors and the information that their
// observations give.
//
//   world_from_first_cam  pose of the first view in the world of the map; the initial map's world
//                         is that view's camera
InitialMapEdit MakeInitialMapEdit(const InitialMap& initial,
                                  const CameraAndPyramid& imaging,
                                  const Rigid3& world_from_first_cam,
                                  KeyFrameId first);

// Renumbers the landmarks of an edit for a map that is empty but may follow others in its atlas,
// because no two maps of an atlas may use the same id.
MapEdit NumberedFor(const Map& map, MapEdit edit);

}  // namespace plumbline

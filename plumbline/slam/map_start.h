// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/association/projection_search.h"
#include "plumbline/base/ids.h"
#include "plumbline/initialization/initializer.h"
#include "plumbline/map/edit.h"
#include "plumbline/map/map.h"

#include <vector>

namespace plumbline {

// A map that begins with several keyframes at once.
struct MapStart {
  MapEdit edit;                       // of an empty map: keyframes, points and lines
  std::vector<KeyFrameId> keyframes;  // by time
  std::vector<FrameId> frames;        // that they were made from
};

// The initial map of a monocular sequence as the first edit of a map. All its views become
// keyframes, numbered from `first` on; landmarks get the looks and the information that their
// observations give.
//
//   world_from_first_cam  pose of the first view in the world of the map; the initial map's world
//                         is that view's camera
MapStart MakeMapStart(const InitialMap& initial,
                      const ImagingModel& imaging,
                      const Rigid3& world_from_first_cam,
                      KeyFrameId first);

// The edit with landmarks numbered for this map, which is empty but may follow others in its atlas:
// no two maps of an atlas use an id.
MapEdit NumberedFor(const Map& map, MapEdit edit);

}  // namespace plumbline

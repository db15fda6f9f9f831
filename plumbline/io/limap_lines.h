// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/map.h"

#include <filesystem>
#include <map>
#include <string>

namespace plumbline {

// Writes the lines of a map with their observed segments in the text form of LIMAP into an existing
// folder. Ids of images and pixels (centres at 0.5, 0.5) are those of the COLMAP model
// (ColmapImageId), so that the files fit the model:
//
//   image_list.txt  number of images; for each its id and name
//   detections.txt  number of images; for each its id and number of segments, then x1 y1 x2 y2
//   alltracks.txt   number of lines; for each its index, number of segments and of images that show
//                   it, then its two ends in the world, the ids of the images, and the indices of
//                   the segments among the detections of these images
//
// The lines are the landmarks, from end to end of their intervals, weak ones included; they are
// counted from 0 in the order of their ids. Throws InputError if a file cannot be written.
void WriteLimapLines(const std::filesystem::path& folder,
                     const Map& map,
                     const std::map<KeyFrameId, std::string>& names);

}  // namespace plumbline

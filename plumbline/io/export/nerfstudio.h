// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/io/export/keyframe_images.h"
#include "plumbline/io/map_file/map_io.h"

#include <filesystem>
#include <map>
#include <span>
#include <string>

namespace plumbline {

// Writes keyframes, followed by other frames, as a data set of nerfstudio (transforms.json): one
// camera without distortion, pixel centres at (0.5, 0.5), and for each frame its image and the pose
// world_from_camera of the rectified left camera, with the axes of OpenGL (x right, y up, z back).
// The world is that of the map.
//
//   images    folder of the images, relative to the file
//   names     names of the images of all keyframes
//   ply_file  file of the points, relative to the file; splats start from it
void WriteNerfstudioTransforms(const std::filesystem::path& path,
                               const SavedMap& saved,
                               const std::string& images,
                               const std::map<KeyFrameId, std::string>& names,
                               const std::string& ply_file,
                               std::span<const PosedImage> others = {});

}  // namespace plumbline

// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/camera.h"
#include "plumbline/io/export/export_camera.h"
#include "plumbline/io/export/keyframe_images.h"
#include "plumbline/io/map_file/map_io.h"

#include <filesystem>
#include <map>
#include <span>
#include <string>

namespace plumbline {

// Returns true if nerfstudio has a camera model that is the same as that of a lens.
bool NerfstudioKnows(const CameraIntrinsics& intrinsics);

// Writes keyframes, followed by other frames, as a data set of nerfstudio (transforms.json): one
// camera, pixel centres at (0.5, 0.5), and for each frame its image and the pose world_from_camera,
// with the axes of OpenGL (x right, y up, z back). The world is that of the map.
//
//   camera    camera of the images, one that NerfstudioKnows
//   names     names of the images of all keyframes
//   ply_file  file of the points, relative to the file; splats start from it
//
// The images are in the folder `images` beside the file.
void WriteNerfstudioTransforms(const std::filesystem::path& path,
                               const SavedMap& saved,
                               const ExportCamera& camera,
                               const std::map<KeyFrameId, std::string>& names,
                               const std::string& ply_file,
                               std::span<const PosedImage> others = {});

}  // namespace plumbline

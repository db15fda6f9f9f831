// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/calibration.h"
#include "plumbline/io/image_file.h"

#include <filesystem>
#include <optional>

namespace plumbline {

// KITTI cameras in use: 0 and 1 are grey, 2 and 3 have colours.
struct KittiCameras {
  int left = 0;
  std::optional<int> right;
};

// Reads the rows `P0: 12 numbers` of the cameras from a calib.txt of KITTI odometry. Its images are
// rectified; `size` is their size, which is not in the file.
//
// body_from_left becomes the pose of the left camera in the frame of camera 0, which is that of the
// ground truth, unless it is camera 0 itself. The cameras 2 and 3 are offset by some millimetres
// vertically and in depth: their pair is not `rectified`.
//
// Throws InputError "FILE:LINE: expected ..., found ..." for rows that are missing or malformed.
Calibration ReadKittiCalibration(const std::filesystem::path& file,
                                 const KittiCameras& cameras,
                                 ImageSize size);

// Images of a KITTI raw drive: rectified (`_sync`) or as taken (`_extract`).
enum class KittiImages { kRectified, kAsTaken };

// Reads the cameras from the calib_cam_to_cam.txt of a KITTI raw drive. The kind of images follows
// from their size: that of S_rect_00 rectified (P_rect_00 is their calibration), that of S_00 as
// taken (K_00, D_00, and R_00, T_00, the motion from camera 0). It is written to `images`, if not
// null. If both sizes are the same, it is `otherwise`.
//
// body_from_left becomes the pose of the left camera in the rectified frame of camera 0
// (R_rect_00), that of the poses of KITTI odometry, unless it is that camera. Throws InputError as
// above.
Calibration ReadKittiRawCalibration(const std::filesystem::path& file,
                                    const KittiCameras& cameras,
                                    ImageSize size,
                                    KittiImages otherwise,
                                    KittiImages* images = nullptr);

}  // namespace plumbline

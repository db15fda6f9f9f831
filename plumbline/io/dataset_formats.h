// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/io/datasets/dataset.h"

#include <filesystem>
#include <memory>
#include <vector>

namespace plumbline {

// Opens a EuRoC folder (mav0/cam0, cam1: data.csv, sensor.yaml; ground truth in
// state_groundtruth_estimate0, of the body). `path` is the folder above mav0 or mav0 itself. Left
// and right frames with equal stamps form a pair; others are left out, with a note. Throws the
// errors of OpenDataset.
std::unique_ptr<Dataset> OpenEuroc(const std::filesystem::path& path,
                                   const DatasetOptions& options);

// Opens a folder of images, in natural order of their names and at the `rate_hz` of the camera
// file. Throws the errors of OpenDataset.
std::unique_ptr<Dataset> OpenImageFolder(const std::filesystem::path& path,
                                         const DatasetOptions& options);

// Returns the possible files of the true poses of a sequence: poses.txt in its folder and, as
// distributed, ../../poses/<sequence>.txt.
std::vector<std::filesystem::path> KittiPosesFiles(const std::filesystem::path& sequence);

// Opens a sequence of KITTI odometry (image_0/, image_1/, calib.txt, times.txt) or a drive of KITTI
// raw (image_00/data/, image_00/timestamps.txt, calib_cam_to_cam.txt there or in the folder of the
// day), rectified or as taken. The grey cameras 0 and 1 are used, or without camera 0 the colour
// cameras 2 and 3. Image N belongs to row N of the times, from 0. Ground truth is that of
// KittiPosesFiles, poses of the rectified camera 0. Throws the errors of OpenDataset.
std::unique_ptr<Dataset> OpenKitti(const std::filesystem::path& path,
                                   const DatasetOptions& options);

// Opens a folder in TUM RGB-D form (rgb.txt, depth.txt, groundtruth.txt; ICL-NUIM without
// depth.txt). A colour image and a depth image are paired if they are mutually nearest in time and
// at most 20 ms apart. Other images are left out of RGB-D, with a note. Throws the errors of
// OpenDataset.
std::unique_ptr<Dataset> OpenTum(const std::filesystem::path& path, const DatasetOptions& options);

// Opens a ROS 1 bag or an MCAP file. recorded_topics.h selects the topics of the cameras. Times are
// those of the sensor (header.stamp), or those of recording if they are not set. Images whose
// stamps are mutually nearest and within 5 ms form a pair; an image and its depth within 20 ms.
// Depth of 16 bits is in millimetres unless the camera file has a depth_factor.
//
// The calibration is the camera file named by the options, a camera.yaml beside the file, or that
// of the recording (recorded_calibration.h). There is no ground truth. Throws the errors of
// OpenDataset. Cost: the whole file is read and unpacked once, some hundred megabytes a second.
std::unique_ptr<Dataset> OpenRecording(const std::filesystem::path& path,
                                       DatasetFormat format,
                                       const DatasetOptions& options);

// Opens a video file as a monocular sequence. Its calibration is the camera file named by the
// options, or a camera.yaml beside the video.
//
// Times are the display times in the container, since its start. A frame without a time follows the
// previous one by the container's rate, with a note. Frames still without one, and the fewest
// possible others, are left out with a note so that times increase; if this affects more than half
// of all, frames are the container's frame period apart, with a note. Frames removed by an edit
// list do not count. Images are rotated as the container says (ChooseTurn).
//
// Frames are best read in order: going back means decoding from the start. Throws the errors of
// OpenDataset, and InputError for a file that is no video, has no frames, or differs in size from
// the calibration. Cost: the whole video is decoded once, since containers are often wrong about
// the number and times of their frames.
std::unique_ptr<Dataset> OpenVideo(const std::filesystem::path& path,
                                   const DatasetOptions& options);

}  // namespace plumbline

// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
//
// SLAM on images that come from anywhere: track_frames CAMERA_FILE (LEFT RIGHT)... > trajectory.txt
#include <iostream>

#include <plumbline/io/cameras/camera_file.h>
#include <plumbline/io/datasets/image_file.h>
#include <plumbline/io/trajectory_io.h>
#include <plumbline/slam/system.h>

int main(int argc, char** argv) {
  if (argc < 4) return 2;
  plumbline::System system(plumbline::ReadCameraFile(argv[1]).calibration,
                           plumbline::SlamOptions{});
  for (int i = 2; i + 1 < argc; i += 2) {
    plumbline::SensorFrame frame;
    frame.stamp_ns = 50'000'000LL * (i / 2 - 1);  // 20 images a second
    const auto left = plumbline::ReadGrayImage(argv[i]);
    const auto right = plumbline::ReadGrayImage(argv[i + 1]);
    if (!left || !right) return 1;
    frame.left = *left;
    frame.right = *right;
    const plumbline::FrameRecord& record = system.Process(std::move(frame));
    if (record.causal_world_from_camera) std::cerr << "tracked\n";  // the pose is known at once
  }
  const plumbline::RunResult result = system.Finish();
  if (const auto map = result.MainMap())
    std::cout << plumbline::FormatTum(result.FinalTrajectory(*map));
}

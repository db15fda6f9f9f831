// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
//
// Tracks a sequence and prints where the camera was: consumer PATH
#include <iostream>

#include <plumbline/io/datasets/open_dataset.h>
#include <plumbline/io/datasets/process_settings.h>
#include <plumbline/slam/system.h>

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  plumbline::SetUpProcess();
  const auto dataset = plumbline::OpenDataset(argv[1]);
  plumbline::System system(dataset->calibration(), plumbline::SlamOptions{});
  for (std::size_t i = 0; i < dataset->size(); ++i) {
    if (const auto frame = dataset->Read(i)) {
      system.Process(*frame);
    } else {
      system.Skip(dataset->stamp_ns(i), "image_unreadable");
    }
  }
  const plumbline::RunResult result = system.Finish();
  const auto map = result.MainMap();
  if (!map) return 1;
  for (const auto& pose : result.FinalTrajectory(*map)) {
    std::cout << pose.stamp_ns << ' ' << pose.world_from_camera.translation.transpose() << '\n';
  }
}

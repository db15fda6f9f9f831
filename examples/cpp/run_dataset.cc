// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
//
// SLAM on a recorded sequence in one call: run_dataset PATH > trajectory.txt
#include <iostream>

#include <plumbline/io/datasets/open_dataset.h>
#include <plumbline/io/datasets/process_settings.h>
#include <plumbline/io/trajectory_io.h>
#include <plumbline/report/run_dataset.h>

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  plumbline::SetUpProcess();
  plumbline::SlamOptions options;
  options.features.line_count = 200;
  const auto result = plumbline::RunDataset(*plumbline::OpenDataset(argv[1]), options);
  const auto map = result.MainMap();
  if (!map) return 1;
  std::cout << plumbline::FormatTum(result.FinalTrajectory(*map));
  std::cerr << result.LineMap(*map).size() << " lines in the map\n";
}

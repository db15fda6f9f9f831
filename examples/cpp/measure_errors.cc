// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
//
// Errors of an estimated trajectory against the ground truth of a data set: measure_errors DATA
// FILE
#include <iostream>

#include <plumbline/io/datasets/open_dataset.h>
#include <plumbline/io/trajectory_io.h>
#include <plumbline/report/trajectory_error.h>

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  const auto dataset = plumbline::OpenDataset(argv[1]);
  if (!dataset->info().ground_truth) return 1;
  const auto truth = dataset->info().ground_truth->OfCamera(dataset->calibration());
  const auto estimate = plumbline::ReadTrajectory(argv[2]).poses;
  const auto error = plumbline::CompareTrajectories(truth, estimate, {});
  if (!error) return 1;  // no two poses of the same time
  std::cout << "ATE " << 1000 * error->ate.rmse << " mm over " << error->poses.size() << " of "
            << estimate.size() << " poses\n";
}

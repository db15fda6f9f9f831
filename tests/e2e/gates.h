// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace plumbline {

// What a run over one of the recorded sequences must reach. To see the figures:
//
//   build/release/plumbline run DATA/SEQUENCE --out /tmp/run
//
// prints them, and /tmp/run/summary.json holds them ("frames", "accuracy").
struct Gate {
  const char* sequence;  // below the data folder
  const char* settings;  // further arguments of the run
  int tracked, skipped;  // frames; all others are failures
  double max_ate_m;      // RMSE of the positions after alignment, metres
};

inline constexpr Gate kMachineHall{"euroc/MH_01_easy_first250", "", 249, 1, 0.005};
inline constexpr Gate kFloor{"tum/rgbd_dataset_freiburg1_floor_first90", "", 90, 0, 0.005};
inline constexpr Gate kRoad{"kitti/06_first51", "", 51, 0, 0.035};
// Motions that nothing foretells: the car drives already in the first frame; every third image
// alone.
inline constexpr Gate kRoadDriving{"kitti/06_first51", "--from 5", 46, 0, 0.025};
inline constexpr Gate kMachineHallFast{"euroc/MH_01_easy_first250", "--stride 3", 84, 0, 0.0055};
// A turn whose first pose rests on few landmarks, and must not draw the map after it: played
// backwards.
inline constexpr Gate kMachineHallFastBack{
    "euroc/MH_01_easy_first250", "--stride 3 --from 2", 82, 1, 0.005};
// Six metres from image to image: little but what is far away shows again.
inline constexpr Gate kRoadFast{"kitti/06_first51", "--stride 5", 11, 0, 0.25};
// The last keyframes have little but lines along the road in common with the others.
inline constexpr Gate kRoadFastLines{"kitti/06_first51", "--stride 3 --from 1", 17, 0, 0.15};
// One camera: the errors are after alignment with a free scale.
inline constexpr Gate kMachineHallMono{
    "euroc/MH_01_easy_first250", "--sensor mono", 250, 0, 0.0055};
inline constexpr Gate kFloorMono{
    "tum/rgbd_dataset_freiburg1_floor_first90", "--sensor mono", 90, 0, 0.0037};
inline constexpr Gate kOfficeMono{
    "icl/office_kt3_first600", "--sensor mono --camera icl_nuim", 600, 0, 0.006};
inline constexpr Gate kRoadMono{"kitti/06_first51", "--sensor mono", 51, 0, 0.04};
// A turn, in which a lens that is 3 px off at the side changes the scale: it has to be learned.
inline constexpr Gate kRoadTurnMono{
    "kitti/07_first160_half",
    "--sensor mono --set features.lines=false --set features.point_count=2000",
    160,
    0,
    0.15};
// A turn at whose end a lens that is 7 px off at the side is learned: lines must move with it.
inline constexpr Gate kRoadLensMono{"kitti/00_first200", "--sensor mono", 200, 0, 0.3};
// Lines only: above all, that the track is kept.
inline constexpr Gate kMachineHallLines{
    "euroc/MH_01_easy_first250", "--set features.points=false", 249, 1, 0.01};

}  // namespace plumbline

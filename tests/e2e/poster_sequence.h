// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/io/export/png.h"

#include "tests/io/scratch_folder.h"
#include "tests/support/moving_poster.h"
#include <filesystem>
#include <string>

#include <fmt/core.h>

namespace plumbline {

// One camera of a poster sequence, `x` metres to the right of the body.
inline std::string PosterSensor(double x) {
  return fmt::format(
      "T_BS:\n  cols: 4\n  rows: 4\n  data: [1,0,0,{}, 0,1,0,0, 0,0,1,0, 0,0,0,1]\nrate_hz: 20\n"
      "resolution: [{}, {}]\ncamera_model: pinhole\nintrinsics: [{}, {}, {}, {}]\n"
      "distortion_model: none\n",
      x,
      MovingPoster::kWidth,
      MovingPoster::kHeight,
      MovingPoster::kFocal,
      MovingPoster::kFocal,
      MovingPoster::kWidth / 2.0,
      MovingPoster::kHeight / 2.0);
}

// The list of `frames` images of a camera of a poster sequence.
inline std::string PosterList(int frames) {
  constexpr int kImages = 12;
  std::string list = "#timestamp [ns],filename\n";
  for (int i = 0; i < frames; ++i) {
    // There and back again, so that a few images make a sequence of any length.
    const int turn = i % (2 * kImages - 2);
    list += fmt::format("{},{}.png\n",
                        1'000'000'000 + 50'000'000LL * i,
                        turn < kImages ? turn : 2 * kImages - 2 - turn);
  }
  return list;
}

// The images of both cameras of a poster sequence, encoded once: cam0_3.png.
inline const ScratchFolder& PosterImages() {
  static const ScratchFolder images;
  static const bool written = [] {
    const MovingPoster poster;
    for (int i = 0; i < 12; ++i) {
      const SensorFrame frame = poster.Frame(i);
      WriteGrayPng(images / fmt::format("cam0_{}.png", i), frame.left);
      WriteGrayPng(images / fmt::format("cam1_{}.png", i), *frame.right);
    }
    return true;
  }();
  (void)written;
  return images;
}

// Writes a EuRoC folder: a stereo camera that goes sideways before a poster, with ground truth of
// the first 12 frames.
inline std::filesystem::path WritePosterSequence(const ScratchFolder& folder, int frames) {
  const std::filesystem::path root = folder / "sequence";
  for (const int camera : {0, 1}) {
    const std::string name = fmt::format("sequence/mav0/cam{}/", camera);
    folder.Write(name + "sensor.yaml", PosterSensor(camera * MovingPoster::kBaseline));
    folder.Write(name + "data.csv", PosterList(frames));
    std::filesystem::create_directories(folder / (name + "data"));
    for (int i = 0; i < 12; ++i) {
      std::filesystem::copy_file(PosterImages() / fmt::format("cam{}_{}.png", camera, i),
                                 folder / (name + fmt::format("data/{}.png", i)));
    }
  }
  std::string truth = "#timestamp,px,py,pz,qw,qx,qy,qz\n";
  for (int i = 0; i < 12; ++i) {
    truth += fmt::format(
        "{},{},0,0,1,0,0,0\n", 1'000'000'000 + 50'000'000LL * i, i * MovingPoster::kStep);
  }
  folder.Write("sequence/mav0/state_groundtruth_estimate0/data.csv", truth);
  return root;
}

}  // namespace plumbline

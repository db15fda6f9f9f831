// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/error.h"
#include "plumbline/base/random.h"
#include "plumbline/io/checkpoint_io.h"
#include "plumbline/slam/system.h"

#include "fuzz/input_folder.h"
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace plumbline {
namespace {

constexpr int kWidth = 160, kHeight = 120;
constexpr double kFocal = 120, kBaseline = 0.12;

Calibration MakeCalibration() {
  Calibration calibration;
  calibration.left = Camera({.fx = kFocal,
                             .fy = kFocal,
                             .cx = kWidth / 2.0,
                             .cy = kHeight / 2.0,
                             .width = kWidth,
                             .height = kHeight});
  calibration.right = calibration.left;
  calibration.right_from_left.translation = {-kBaseline, 0, 0};
  calibration.rectified = true;
  calibration.rate_hz = 20;
  return calibration;
}

SlamOptions MakeOptions() {
  SlamOptions options;
  options.slam.mode = RunMode::kInline;
  options.features.parallel = false;
  options.features.point_count = 100;
  options.features.line_count = 15;
  return options;
}

// Rectangles of all shades, wider than an image, so that the camera can go along it.
GrayImage MakePicture() {
  GrayImage picture(2 * kWidth, kHeight, 128);
  Rng rng(5, "checkpoint_fuzz");
  for (int i = 0; i < 400; ++i) {
    const auto left = static_cast<int>(rng.Index(2 * kWidth));
    const auto top = static_cast<int>(rng.Index(kHeight));
    const auto right = std::min(2 * kWidth, left + 4 + static_cast<int>(rng.Index(16)));
    const auto bottom = std::min(kHeight, top + 4 + static_cast<int>(rng.Index(16)));
    const auto shade = static_cast<std::uint8_t>(rng.Index(256));
    for (int y = top; y < bottom; ++y) {
      for (int x = left; x < right; ++x) picture.at(x, y) = shade;
    }
  }
  return picture;
}

GrayImage Part(const GrayImage& picture, int from) {
  GrayImage part(kWidth, kHeight, 0);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) part.at(x, y) = picture.at(from + x, y);
  }
  return part;
}

// Frame i of a stereo camera that goes along the picture.
SensorFrame FrameAt(int i) {
  static const GrayImage picture = MakePicture();
  SensorFrame frame;
  frame.stamp_ns = 1'000'000'000 + std::int64_t{50'000'000} * i;
  frame.left = Part(picture, 3 * i);
  frame.right = Part(picture, 3 * i + 6);
  return frame;
}

constexpr int kFrames = 8;

// A short run in the middle.
SavedRun MakeRun() {
  System system(MakeCalibration(), MakeOptions());
  for (int i = 0; i < kFrames; ++i) system.Process(FrameAt(i));
  return system.Save();
}

// The bytes with other ones in some places: for each place its number (four bytes, modulo the
// size), how many follow (a byte), and these. A count of 255 ends the bytes there.
std::string Edited(std::string bytes, std::string_view edits) {
  constexpr std::size_t kHead = 5;
  while (edits.size() >= kHead && !bytes.empty()) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(edits[i]); };
    const std::size_t place =
        (byte(0) + 256U * byte(1) + 65536U * byte(2) + 16777216U * byte(3)) % bytes.size();
    const std::size_t count = byte(4);
    edits.remove_prefix(kHead);
    if (count == 255) {
      bytes.resize(place);
      continue;
    }
    const std::string_view put = edits.substr(0, std::min(count, bytes.size() - place));
    std::copy(put.begin(), put.end(), bytes.begin() + static_cast<std::ptrdiff_t>(place));
    edits.remove_prefix(put.size());
  }
  return bytes;
}

// What the program does with a checkpoint: one that it goes on from serves for another one.
void GoOn(const SavedRun& run) {
  System system(MakeCalibration(), MakeOptions());
  try {
    system.Resume(run);
  } catch (const InputError&) {
    return;
  }
  const SavedRun again = system.Save();
  System other(MakeCalibration(), MakeOptions());
  other.Resume(again);
}

}  // namespace
}  // namespace plumbline

// Checkpoints of runs. After an 'E' the input says what of the state of a real one is changed; no
// mutation of a whole file would get past its checksums. Otherwise it is the whole file.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace plumbline;
  static const InputFolder folder;
  static const SavedRun real = MakeRun();
  const std::string_view text = AsText(data, size);
  if (text.starts_with('E')) {
    SavedRun run = real;
    run.state = Edited(run.state, text.substr(1));
    GoOn(run);
    return 0;
  }
  try {
    GoOn(LoadCheckpoint(folder.Write("run.plbrun", text)));
  } catch (const InputError&) {
  }
  return 0;
}

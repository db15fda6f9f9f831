// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
//
// Time of the adjustment that ends a run, on maps that runs wrote: final_adjustment MAP.plb...
#include "lab/bench/run_bench.h"
#include "plumbline/base/error.h"
#include "plumbline/io/map_file/map_io.h"
#include "plumbline/mapping/whole_map_adjustment.h"

#include <chrono>

#include <fmt/format.h>

namespace {

using plumbline::CameraAndPyramid;
using plumbline::LineSettings;
using plumbline::MappingOptions;

void Measure(const char* path) {
  const plumbline::SavedMap saved = plumbline::LoadMap(path);
  CameraAndPyramid imaging;
  imaging.camera = saved.camera;
  MappingOptions options;
  options.final_adjustment_keyframes = 1'000'000;
  const auto start = std::chrono::steady_clock::now();
  const plumbline::MapCorrection correction =
      plumbline::AdjustWholeMap(saved.map, imaging, LineSettings{}, options);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  fmt::print("{}: {} keyframes, {} points, {} lines, {} poses moved, {:.2f} s\n",
             path,
             saved.map.keyframes().size(),
             saved.map.points().size(),
             saved.map.lines().size(),
             correction.keyframes.size(),
             seconds.count());
}

}  // namespace

int main(int count, char** arguments) {
  return plumbline::bench::RunBench("final_adjustment", [&] {
    if (count < 2) throw plumbline::InputError("expected MAP...");
    for (int i = 1; i < count; ++i) Measure(arguments[i]);
  });
}

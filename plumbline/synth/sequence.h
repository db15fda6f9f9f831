// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/options.h"
#include "plumbline/geometry/calibration.h"
#include "plumbline/geometry/trajectory.h"
#include "plumbline/image/image.h"
#include "plumbline/synth/renderer.h"
#include "plumbline/synth/world.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>

namespace plumbline {

// A stereo sequence of a still world, made on demand: pairs, their exact poses, the exact lines.
//
// Frame i is taken at StampNs(i). The body (what the ground truth is about, as in
// EuRoC) is not the camera: calibration().body_from_left. Everything is a function of the options;
// Render may be called from several threads.
class StereoSequence {
 public:
  // Throws InputError for an unknown world, with the names there are. `threads` speeds up the
  // preparation of the textures.
  StereoSequence(std::string_view world, const SynthOptions& options, int threads);

  int size() const { return frames_; }
  std::int64_t StampNs(int frame) const;
  const std::string& world() const { return world_; }
  const SynthOptions& options() const { return options_; }
  const Calibration& calibration() const { return calibration_; }
  const Scene& scene() const { return made_.scene; }

  Rigid3 WorldFromLeft(double time) const { return made_.path.world_from_camera(time); }
  // Poses of the left camera, `per_frame` of them for each frame interval, from the first frame to
  // the last.
  Trajectory GroundTruth(int per_frame = 1) const;

  // What the ideal sensor sees: camera 0 is the left one.
  Rendering RenderIdeal(int frame, int camera) const;
  // What the camera delivers: exposure, vignetting, noise, rounding.
  GrayImage RenderImage(int frame, int camera) const;

 private:
  std::string world_;
  SynthOptions options_;
  Calibration calibration_;
  World made_;
  int frames_;
  Renderer renderer_;
  RayTable left_rays_;
  RayTable right_rays_;
};

// Writes a sequence as a EuRoC folder (mav0/cam0, cam1, state_groundtruth_estimate0 at 200 Hz)
// with, beside mav0, `lines.csv` (the edges of all bodies, x1,y1,z1,x2,y2,z2, metres, world frame)
// and `world.yaml` (the options). `progress`, where given, is called after each pair with the
// number of pairs done, one call at a time. The bytes written depend on neither the machine's load
// nor `threads`. Throws InputError when a file cannot be written.
void WriteSequence(const StereoSequence& sequence,
                   const std::filesystem::path& folder,
                   int threads,
                   const std::function<void(int)>& progress = {});

}  // namespace plumbline

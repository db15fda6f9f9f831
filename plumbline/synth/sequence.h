// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/options.h"
#include "plumbline/geometry/calibration.h"
#include "plumbline/geometry/trajectory.h"
#include "plumbline/image/image.h"
#include "plumbline/synth/path.h"
#include "plumbline/synth/renderer.h"
#include "plumbline/synth/scene.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>

namespace plumbline {

struct SynthOptions {
  int frames = 200;
  double rate_hz = 20;
  double loop_s = 10;      // time for one turn of the path
  double baseline = 0.11;  // metres
  bool distortion = true;  // radial-tangential lens, as in EuRoC; false: ideal pinhole
  double exposure = 1.25;  // brightness of the image
  double noise = 1;        // sensor noise, 1 as a real camera, 0 none
  double texel = 0.003;    // metres; coarser is prepared faster and blurs what is near
  std::uint64_t seed = 1;  // of the textures, the furniture, the path and the noise
};

template <class Visitor>
void VisitFields(Visitor&& visit, SynthOptions& o) {
  visit("frames", o.frames, "number of stereo pairs", Range{1, 1e6});
  visit("rate_hz", o.rate_hz, "pairs per second", Range{0.1, 1000});
  visit("loop_s", o.loop_s, "time for one turn of the closed path [s]", Range{5, 1000});
  visit("baseline", o.baseline, "distance of the two cameras [m]", Range{0.01, 1});
  visit("distortion", o.distortion, "lens distortion; without it an ideal rectified pair");
  visit("exposure", o.exposure, "brightness of the images", Range{0.05, 20});
  visit("noise", o.noise, "sensor noise, 1 as a real camera, 0 none", Range{0, 20});
  visit("texel", o.texel, "size of a texture cell [m]", Range{0.001, 0.1});
  visit("seed", o.seed, "seed of textures, furniture, path and noise");
}

// A world that can be rendered as a recorded sequence.
struct World {
  const char* name;
  const char* help;
};

// The worlds there are, in the order shown to users.
std::span<const World> Worlds();

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

  int size() const { return options_.frames; }
  std::int64_t StampNs(int frame) const;
  const std::string& world() const { return world_; }
  const SynthOptions& options() const { return options_; }
  const Calibration& calibration() const { return calibration_; }
  const Scene& scene() const { return scene_; }

  Rigid3 WorldFromLeft(double time) const { return path_.WorldFromCamera(time); }
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
  Scene scene_;
  HandHeldLoop path_;
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

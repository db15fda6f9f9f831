// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/calibration.h"
#include "plumbline/geometry/trajectory.h"
#include "plumbline/image/image.h"
#include "worlds/imu.h"
#include "worlds/overlay.h"
#include "worlds/renderer.h"
#include "worlds/sensor.h"
#include "worlds/synth_options.h"
#include "worlds/true_lines.h"
#include "worlds/world.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace plumbline {

// A recording of a world, made on demand: stereo pairs, depth, inertial samples, exact poses.
//
// Frame i is taken at StampNs(i), the middle of its exposure (of the middle row with a rolling
// shutter). The body (the frame of EuRoC's ground truth and inertial sensor) is not the camera:
// calibration().body_from_left. Everything is a function of world and options; the Render functions
// may be called from several threads.
class SyntheticSequence {
 public:
  // `world` is a name or a file (OpenWorld). Throws InputError for an unknown world or options that
  // contradict each other. `threads` speeds up the preparation of textures and light.
  SyntheticSequence(std::string_view world, const SynthOptions& options, int threads);
  SyntheticSequence(const WorldSource& source, const SynthOptions& options, int threads);

  int size() const { return frames_; }
  std::int64_t StampNs(int frame) const;
  const std::string& world() const { return world_; }
  // The text of the file that describes the world; empty for a built-in one.
  const std::string& world_text() const { return world_text_; }
  const SynthOptions& options() const { return options_; }
  const Calibration& calibration() const { return calibration_; }
  const Scene& scene() const { return made_.scene; }
  const Renderer& renderer() const { return renderer_; }

  // Seconds from the first frame.
  double TimeOf(int frame) const;
  Rigid3 WorldFromLeft(double time) const { return made_.path.world_from_camera(time); }
  Rigid3 WorldFromBody(double time) const;
  // Poses of the left camera, `per_frame` of them for each frame interval, from the first frame to
  // the last.
  Trajectory GroundTruth(int per_frame = 1) const;
  ImuRecording Imu() const;
  // Returns the true lines of the world visible to the left camera, see TrueLines.
  std::vector<TrueLine> Lines(int threads) const;

  // Returns the image of the ideal sensor: camera 0 is the left one.
  Rendering RenderIdeal(int frame, int camera) const;
  // Returns the camera's image of it: exposure, vignetting, noise, response, rounding.
  GrayImage Sense(const Image<float>& light, int frame, int camera) const;
  // Black where SynthOptions::person is in an image.
  GrayImage MaskOfPerson(int frame, int camera) const;
  GrayImage RenderImage(int frame, int camera) const {
    return Sense(RenderIdeal(frame, camera).light, frame, camera);
  }
  // Returns the depth of a sensor registered to the left camera.
  DepthImage SenseDepthOf(const DepthImage& depth, int frame) const;

 private:
  const Camera& CameraOf(int camera) const;
  Person PersonIn(int frame, int camera) const;
  std::vector<double> FindGains(int threads) const;

  std::string world_;
  std::string world_text_;
  SynthOptions options_;
  Calibration calibration_;
  World made_;
  int frames_;
  Renderer renderer_;
  RayTable left_rays_;
  RayTable right_rays_;
  std::vector<double> gains_;  // of each frame, by auto exposure; empty without
};

}  // namespace plumbline

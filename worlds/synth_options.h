// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/options.h"
#include "worlds/imu.h"

#include <array>
#include <cstdint>
#include <type_traits>
#include <utility>

namespace plumbline {

// Pair of cameras that records a world, without its baseline.
enum class SynthCamera {
  kEuroc,  // 752 x 480, focal length 458 px, with or without lens distortion
  kKitti,  // 1241 x 376, focal length 718.856 px, ideal and rectified
  kTumVi,  // 512 x 512, focal length 191 px, fisheye lenses of 195 degrees across the corners
};
constexpr auto EnumNames(std::type_identity<SynthCamera>) {
  return std::array{std::pair{SynthCamera::kEuroc, "euroc"},
                    std::pair{SynthCamera::kKitti, "kitti"},
                    std::pair{SynthCamera::kTumVi, "tum_vi"}};
}

// Lens of SynthCamera::kEuroc. kEuroc is EuRoC's; the others show `view_deg` across: pinhole
// without distortion, and the models of DistortionModel with numbers of the size of real lenses.
enum class SynthLens {
  kEuroc,
  kPinhole,
  kEquidistant,
  kRational,
  kFov,
  kDoubleSphere,
  kEucm,
  kOmni
};
constexpr auto EnumNames(std::type_identity<SynthLens>) {
  return std::array{std::pair{SynthLens::kEuroc, "euroc"},
                    std::pair{SynthLens::kPinhole, "pinhole"},
                    std::pair{SynthLens::kEquidistant, "equidistant"},
                    std::pair{SynthLens::kRational, "rational"},
                    std::pair{SynthLens::kFov, "fov"},
                    std::pair{SynthLens::kDoubleSphere, "double_sphere"},
                    std::pair{SynthLens::kEucm, "eucm"},
                    std::pair{SynthLens::kOmni, "omni"}};
}

// Recording of a world: camera, sensor, path, amount of work.
struct SynthOptions {
  int frames = 0;  // 0: the whole path
  double rate_hz = 20;
  int path = 1;      // 2: the second visit, if the world has one
  double speed = 1;  // of the path, 1 is the world's own
  SynthCamera camera = SynthCamera::kEuroc;
  double scale = 1;        // of the image, 1 is the camera's
  double baseline = 0.11;  // metres
  SynthLens lens = SynthLens::kEuroc;
  double view_deg = 120;   // across, of all lenses but kEuroc
  bool distortion = true;  // radial-tangential lens, as in EuRoC; false: ideal pinhole
  int samples = 4;         // per pixel
  double shutter_ms = 0;   // exposure time; 0: an instant, no motion blur
  int time_samples = 16;   // least number over the exposure
  double readout_ms = 0;   // from the first row to the last; 0: all rows at once
  double exposure = 1.25;  // brightness of the image
  bool auto_exposure = false;
  double gamma = 1;  // of the response curve, 1 linear
  double vignetting = 0.22;
  double lens_blur = 0.5;  // pixels
  double noise = 1;
  bool depth = false;  // depth images in the EuRoC format too
  double depth_noise = 1;
  bool text = false;    // a line of letters in all images
  bool person = false;  // somebody who walks by in half of the images
  double imu_rate_hz = 200;
  double imu_noise = 1;
  ImuFaults imu;
  double texel = 0.7;           // pixels
  double finest_texel = 0.002;  // metres
  std::uint64_t seed = 1;
};

// True unless the camera is EuRoC's or KITTI's with its own lens: then a camera.yaml describes it.
inline bool HasOtherLens(const SynthOptions& options) {
  return options.lens != SynthLens::kEuroc || options.camera == SynthCamera::kTumVi;
}

template <class Visitor>
void VisitFields(Visitor&& visit, SynthOptions& o) {
  visit("frames", o.frames, "number of frames, at most; 0: the whole path", Range{0, 1e6});
  visit("rate_hz", o.rate_hz, "frames per second", Range{0.1, 1000});
  visit("path", o.path, "the way of the camera; 2: that of a second visit", Range{1, 2});
  visit("speed", o.speed, "of the path, 1 as the world has it", Range{0.05, 20});
  visit("camera",
        o.camera,
        "euroc: 752 x 480 with a wide lens; kitti: 1241 x 376, ideal and rectified; tum_vi: 512 x "
        "512 with a fisheye lens");
  visit("scale", o.scale, "of the image, 1 is that of the camera", Range{0.1, 4});
  visit("baseline", o.baseline, "distance of the two cameras [m]", Range{0.01, 1});
  visit("lens",
        o.lens,
        "of camera: euroc; all but euroc show view_deg across, and are written as camera.yaml");
  visit("view_deg", o.view_deg, "view of the lens across [degrees]", Range{40, 220});
  visit("distortion", o.distortion, "lens distortion; without it an ideal rectified pair");
  visit("samples", o.samples, "samples per pixel against aliasing", Range{1, 64});
  visit("shutter_ms", o.shutter_ms, "time the shutter is open, 0: no motion blur", Range{0, 200});
  visit("time_samples",
        o.time_samples,
        "least number of them while the shutter is open",
        Range{2, 256});
  visit(
      "readout_ms", o.readout_ms, "rolling shutter: from the first row to the last", Range{0, 200});
  visit("exposure", o.exposure, "brightness of the images", Range{0.02, 50});
  visit("auto_exposure", o.auto_exposure, "brightness follows the scene, as a camera sets it");
  visit("gamma", o.gamma, "of the response curve, 1 linear", Range{1, 3});
  visit("vignetting", o.vignetting, "loss of light in the corners", Range{0, 0.9});
  visit("lens_blur", o.lens_blur, "unsharpness of the lens, sigma [px]", Range{0, 1});
  visit("noise", o.noise, "sensor noise, 1 as a real camera, 0 none", Range{0, 20});
  visit("depth", o.depth, "write depth images in the EuRoC format too (TUM always has them)");
  visit("depth_noise",
        o.depth_noise,
        "of the depth images, 1 as a real sensor, 0 none",
        Range{0, 20});
  visit("text", o.text, "a line of letters in all images; mask_text.png is black there");
  visit("person",
        o.person,
        "somebody walks by in half of the images; mask0 and mask1 are black there");
  visit("imu_rate_hz", o.imu_rate_hz, "samples of the inertial sensor per second", Range{1, 2000});
  visit("imu_noise", o.imu_noise, "of the inertial sensor, 1 as in EuRoC, 0 none", Range{0, 100});
  visit("imu", o.imu, "what the inertial sensor does beside noise");
  visit("texel", o.texel, "texture cell [px] where the path comes closest", Range{0.2, 50});
  visit("finest_texel", o.finest_texel, "but no smaller than this [m]", Range{0.0005, 1});
  visit("seed", o.seed, "seed of textures, furniture, path and noise");
}

}  // namespace plumbline

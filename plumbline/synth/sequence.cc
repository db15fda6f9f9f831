// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/synth/sequence.h"

#include "plumbline/base/error.h"
#include "plumbline/synth/noise.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace plumbline {
namespace {

constexpr int kWidth = 752, kHeight = 480;
constexpr std::int64_t kFirstStampNs = 1'500'000'000'000'000'000;
constexpr double kNanosecondsPerSecond = 1e9;

Camera MakeCamera(bool distortion, bool right) {
  CameraIntrinsics intrinsics;
  intrinsics.fx = 458.2;
  intrinsics.fy = 457.5;
  intrinsics.cx = 371.4;
  intrinsics.cy = 243.6;
  intrinsics.width = kWidth;
  intrinsics.height = kHeight;
  if (distortion) {
    intrinsics.model = DistortionModel::kRadTan;
    intrinsics.distortion = {-0.283, 0.0742, 0.0002, 0.00002, 0};
    if (right) {  // no two lenses are alike
      intrinsics.fx = 457.1;
      intrinsics.fy = 456.2;
      intrinsics.cx = 378.0;
      intrinsics.cy = 252.3;
      intrinsics.distortion = {-0.2835, 0.0747, -0.0001, -0.00004, 0};
    }
  }
  return Camera(intrinsics);
}

Calibration MakeCalibration(const SynthOptions& options) {
  Calibration calibration;
  calibration.left = MakeCamera(options.distortion, false);
  calibration.right = MakeCamera(options.distortion, true);
  calibration.right_from_left.translation = {-options.baseline, 0, 0};
  if (options.distortion) {  // nor is any pair mounted in perfect alignment
    calibration.right_from_left.rotation = ExpSo3({0.0021, -0.0044, 0.0016});
    calibration.right_from_left.translation += Eigen::Vector3d(0, 0.0004, -0.0008);
  }
  calibration.rectified = !options.distortion;
  calibration.rate_hz = options.rate_hz;
  // The body looks along its own x axis, z up, and carries the camera a little ahead of itself.
  Eigen::Matrix3d axes;
  axes << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  const Eigen::Quaterniond mount = Eigen::Quaterniond(axes) * ExpSo3({0.012, -0.02, 0.008});
  calibration.body_from_left = Rigid3{mount.normalized(), {0.08, 0.5 * options.baseline, 0.02}};
  return calibration;
}

}  // namespace

StereoSequence::StereoSequence(std::string_view world, const SynthOptions& options, int threads)
    : world_(world),
      options_(options),
      calibration_(MakeCalibration(options)),
      made_(FindWorld(world).make(options.seed)),
      frames_(options.frames > 0 ? options.frames
                                 : static_cast<int>(made_.path.duration * options.rate_hz)),
      renderer_(made_.scene, {.texel = 0.004, .threads = threads}),
      left_rays_(calibration_.left),
      right_rays_(*calibration_.right) {}

std::int64_t StereoSequence::StampNs(int frame) const {
  return kFirstStampNs + std::llround(frame * kNanosecondsPerSecond / options_.rate_hz);
}

Trajectory StereoSequence::GroundTruth(int per_frame) const {
  PLUMBLINE_CHECK(per_frame >= 1, "poses per frame");
  Trajectory poses;
  for (int i = 0; i <= (size() - 1) * per_frame; ++i) {
    // Stamps of frames come out of StampNs itself, so that they agree to the nanosecond.
    const std::int64_t begin = StampNs(i / per_frame), end = StampNs(i / per_frame + 1);
    const std::int64_t stamp = begin + (end - begin) * (i % per_frame) / per_frame;
    const double time = static_cast<double>(stamp - kFirstStampNs) / kNanosecondsPerSecond;
    poses.push_back({stamp, WorldFromLeft(time)});
  }
  return poses;
}

Rendering StereoSequence::RenderIdeal(int frame, int camera) const {
  PLUMBLINE_CHECK(frame >= 0 && frame < size(), "frame of the sequence");
  PLUMBLINE_CHECK(camera == 0 || camera == 1, "camera of the pair");
  const double time = static_cast<double>(StampNs(frame) - kFirstStampNs) / kNanosecondsPerSecond;
  const Rigid3 world_from_left = WorldFromLeft(time);
  if (camera == 0) return renderer_.Render(left_rays_, world_from_left);
  return renderer_.Render(right_rays_, world_from_left * Inverse(calibration_.right_from_left));
}

GrayImage StereoSequence::RenderImage(int frame, int camera) const {
  constexpr float kVignetting = 0.22F;                          // loss of light in the corners
  constexpr float kReadVariance = 1.5F, kShotVariance = 0.02F;  // per grey level squared
  const Rendering ideal = RenderIdeal(frame, camera);
  const std::uint64_t stream = HashCell(frame, camera, MixBits(options_.seed + 0x5EED0F0015EULL));
  const auto exposure = static_cast<float>(options_.exposure);
  const auto noise = static_cast<float>(options_.noise);
  const float centre_x = 0.5F * (kWidth - 1), centre_y = 0.5F * (kHeight - 1);
  const float corner = centre_x * centre_x + centre_y * centre_y;
  GrayImage image(kWidth, kHeight);
  for (int y = 0; y < kHeight; ++y) {
    const float dy = static_cast<float>(y) - centre_y;
    for (int x = 0; x < kWidth; ++x) {
      const float dx = static_cast<float>(x) - centre_x;
      const float fall_off = 1 - kVignetting * (dx * dx + dy * dy) / corner;
      const float light = std::min(exposure * fall_off * ideal.light.at(x, y), 400.0F);
      const float sigma = noise * std::sqrt(kReadVariance + kShotVariance * light);
      const float value = light + sigma * NormalFromHash(HashCell(x, y, stream));
      image.at(x, y) = static_cast<std::uint8_t>(std::clamp(value + 0.5F, 0.0F, 255.0F));
    }
  }
  return image;
}

}  // namespace plumbline

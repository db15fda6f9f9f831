// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "worlds/sequence.h"

#include "plumbline/base/elementary.h"
#include "plumbline/base/error.h"
#include "plumbline/base/parallel.h"
#include "plumbline/base/units.h"
#include "worlds/noise.h"
#include "worlds/world_catalog.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <optional>
#include <string>

namespace plumbline {
namespace {

constexpr std::int64_t kFirstStampNs = 1'500'000'000'000'000'000;
constexpr double kNanosecondsPerSecond = 1e9;
constexpr std::uint64_t kNoiseStream = 0x5EED0F0015EULL, kDepthStream = 0xDE97, kImuStream = 0x1A5;

// Options that do not contradict each other.
const SynthOptions& Checked(const SynthOptions& options) {
  const double frame_ms = 1000 / options.rate_hz;
  if (options.shutter_ms + options.readout_ms > frame_ms) {
    throw InputError("shutter_ms + readout_ms: expected at most the " + std::to_string(frame_ms) +
                     " ms between two frames, found " +
                     std::to_string(options.shutter_ms + options.readout_ms));
  }
  if (options.camera == SynthCamera::kKitti && options.distortion) {
    throw InputError("distortion: expected false with camera: kitti, found true");
  }
  if (options.camera != SynthCamera::kEuroc && options.lens != SynthLens::kEuroc) {
    throw InputError("lens: expected euroc with another camera, found another one");
  }
  return options;
}

CameraIntrinsics Scaled(CameraIntrinsics k, double scale) {
  k.fx *= scale;
  k.fy *= scale;
  k.cx = scale * (k.cx + 0.5) - 0.5;  // pixel centres at integers
  k.cy = scale * (k.cy + 0.5) - 0.5;
  k.width = static_cast<int>(std::lround(scale * k.width));
  k.height = static_cast<int>(std::lround(scale * k.height));
  return k;
}

CameraIntrinsics EurocIntrinsics(bool distortion, bool right) {
  CameraIntrinsics intrinsics;
  intrinsics.fx = 458.2;
  intrinsics.fy = 457.5;
  intrinsics.cx = 371.4;
  intrinsics.cy = 243.6;
  intrinsics.width = 752;
  intrinsics.height = 480;
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
  return intrinsics;
}

// A lens that shows `view_deg` across on a chip of EuRoC's size. The right one differs a little.
CameraIntrinsics WideIntrinsics(const SynthOptions& options, bool right) {
  struct Numbers {
    DistortionModel model = DistortionModel::kNone;
    std::array<double, kMostCoefficients> distortion{};
  };
  const auto numbers = [&]() -> Numbers {
    switch (options.lens) {
      case SynthLens::kEquidistant:
        return {DistortionModel::kEquidistant, {0.0035, 0.0007, -0.002, 0.0002}};
      case SynthLens::kRational:
        return {DistortionModel::kRational, {8.5, 4.2, 0.0002, -0.0001, 0.21, 8.85, 7.06, 1.1}};
      case SynthLens::kFov:
        return {DistortionModel::kFov, {0.93}};
      case SynthLens::kDoubleSphere:
        return {DistortionModel::kDoubleSphere, {-0.18, 0.59}};
      case SynthLens::kEucm:
        return {DistortionModel::kEucm, {0.63, 1.04}};
      case SynthLens::kOmni:
        return {DistortionModel::kOmni, {1.4, -0.03, 0.01, 0.0002, 0.0001}};
      case SynthLens::kEuroc:
      case SynthLens::kPinhole:
        break;
    }
    return {};
  }();
  CameraIntrinsics intrinsics = EurocIntrinsics(false, right);
  intrinsics.fx = intrinsics.fy = 1;
  intrinsics.model = numbers.model;
  intrinsics.distortion = numbers.distortion;
  const double half = 0.5 * options.view_deg * kDegree;
  CameraIntrinsics unit = intrinsics;
  unit.cx = unit.cy = 0;
  const std::optional<Eigen::Vector2d> border =
      Camera(unit).Project({math::Sin(half), 0, math::Cos(half)});
  if (!border) {
    throw InputError("view_deg: expected a view that the lens has, found " +
                     std::to_string(options.view_deg));
  }
  const double no_two_are_alike = right ? 0.998 : 1;
  intrinsics.fx = no_two_are_alike * 0.5 * intrinsics.width / border->x();
  intrinsics.fy = 0.999 * intrinsics.fx;
  return intrinsics;
}

// Intrinsics of the odometry sequences 00 to 02.
CameraIntrinsics KittiIntrinsics() {
  CameraIntrinsics intrinsics;
  intrinsics.fx = intrinsics.fy = 718.856;
  intrinsics.cx = 607.1928;
  intrinsics.cy = 185.2157;
  intrinsics.width = 1241;
  intrinsics.height = 376;
  return intrinsics;
}

// Intrinsics of the TUM VI data set at 512 x 512: the published calibration.
CameraIntrinsics TumViIntrinsics(bool right) {
  CameraIntrinsics intrinsics;
  intrinsics.fx = right ? 190.442 : 190.978;
  intrinsics.fy = right ? 190.434 : 190.973;
  intrinsics.cx = right ? 252.597 : 254.931;
  intrinsics.cy = right ? 254.917 : 256.897;
  intrinsics.width = intrinsics.height = 512;
  intrinsics.model = DistortionModel::kEquidistant;
  intrinsics.distortion = {0.00348, 0.000715, -0.002053, 0.000203};
  if (right) intrinsics.distortion = {0.0034, 0.001766, -0.002663, 0.00033};
  return intrinsics;
}

Camera MakeCamera(const SynthOptions& options, bool right, double scale) {
  if (options.lens != SynthLens::kEuroc) {
    return Camera(Scaled(WideIntrinsics(options, right), scale));
  }
  if (options.camera == SynthCamera::kTumVi) return Camera(Scaled(TumViIntrinsics(right), scale));
  return Camera(Scaled(options.camera == SynthCamera::kKitti
                           ? KittiIntrinsics()
                           : EurocIntrinsics(options.distortion, right),
                       scale));
}

Calibration MakeCalibration(const SynthOptions& options) {
  Calibration calibration;
  calibration.left = MakeCamera(options, false, options.scale);
  calibration.right = MakeCamera(options, true, options.scale);
  calibration.right_from_left.translation = {-options.baseline, 0, 0};
  const bool rectified = !options.distortion && !HasOtherLens(options);
  if (!rectified) {  // nor is any pair mounted in perfect alignment
    calibration.right_from_left.rotation = ExpSo3({0.0021, -0.0044, 0.0016});
    calibration.right_from_left.translation += Eigen::Vector3d(0, 0.0004, -0.0008);
  }
  calibration.rectified = rectified;
  calibration.rate_hz = options.rate_hz;
  // The body looks along its own x axis, z up, and carries the camera a little ahead of itself.
  Eigen::Matrix3d axes;
  axes << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  const Eigen::Quaterniond mount = Eigen::Quaterniond(axes) * ExpSo3({0.012, -0.02, 0.008});
  calibration.body_from_left = Rigid3{mount.normalized(), {0.08, 0.5 * options.baseline, 0.02}};
  return calibration;
}

World MakeWorld(const WorldSource& source, const SynthOptions& options) {
  World world = source.make(options.seed);
  if (options.path == 2) {
    if (!world.second_path) {
      throw InputError("path: expected 1, found 2: " + source.name + " has one way only");
    }
    world.path = *std::move(world.second_path);
  }
  if (options.speed != 1) world.path = Faster(std::move(world.path), options.speed);
  return world;
}

int CountFrames(const CameraPath& path, const SynthOptions& options) {
  const int whole = std::max(2, static_cast<int>(std::floor(path.duration * options.rate_hz)));
  return options.frames > 0 ? std::min(options.frames, whole) : whole;
}

// A share of a pixel at the closest distance of the path from a surface; 1 m for bodies.
std::vector<double> TexelSizes(const World& world,
                               const SynthOptions& options,
                               double focal,
                               double seconds) {
  constexpr double kCoarsest = 0.05, kStep = 0.2, kBodies = 1;
  std::vector<Eigen::Vector3d> places;
  for (double time = 0; time < seconds + kStep; time += kStep) {
    places.push_back(world.path.world_from_camera(time).translation);
  }
  std::vector<double> texels;
  for (const Surface& surface : world.scene.surfaces) {
    double closest = kBodies;
    if (!surface.body) {
      closest = std::transform_reduce(
          places.begin(),
          places.end(),
          1e9,
          [](double a, double b) { return std::min(a, b); },
          [&](const Eigen::Vector3d& place) { return surface.DistanceTo(place); });
    }
    const double texel = options.texel * closest / focal;
    texels.push_back(
        std::clamp(texel, options.finest_texel, std::max(options.finest_texel, kCoarsest)));
  }
  return texels;
}

// Pixels per radian in the middle.
double FocalOf(const SynthOptions& options, const Camera& left) {
  return HasOtherLens(options) ? left.CentreFocal() : left.intrinsics().fx;
}

RendererOptions MakeRendererOptions(
    const World& world, const SynthOptions& options, double focal, int frames, int threads) {
  RendererOptions made;
  made.samples = options.samples;
  made.time_samples = options.time_samples;
  made.texels = TexelSizes(world, options, focal, frames / options.rate_hz);
  made.threads = threads;
  return made;
}

double Mean(const Image<float>& image) {
  const auto count =
      static_cast<std::size_t>(image.width()) * static_cast<std::size_t>(image.height());
  return std::accumulate(image.data(), image.data() + count, 0.0) / static_cast<double>(count);
}

}  // namespace

SyntheticSequence::SyntheticSequence(std::string_view world,
                                     const SynthOptions& options,
                                     int threads)
    : SyntheticSequence(OpenWorld(world), options, threads) {}

SyntheticSequence::SyntheticSequence(const WorldSource& source,
                                     const SynthOptions& options,
                                     int threads)
    : world_(source.name),
      world_text_(source.text),
      options_(Checked(options)),
      calibration_(MakeCalibration(options)),
      made_(MakeWorld(source, options)),
      frames_(CountFrames(made_.path, options)),
      renderer_(made_.scene,
                MakeRendererOptions(
                    made_, options, FocalOf(options, calibration_.left), frames_, threads)),
      left_rays_(calibration_.left),
      right_rays_(*calibration_.right) {
  if (options.auto_exposure) gains_ = FindGains(threads);
}

std::int64_t SyntheticSequence::StampNs(int frame) const {
  return kFirstStampNs + std::llround(frame * kNanosecondsPerSecond / options_.rate_hz);
}

double SyntheticSequence::TimeOf(int frame) const {
  return static_cast<double>(StampNs(frame) - kFirstStampNs) / kNanosecondsPerSecond;
}

Rigid3 SyntheticSequence::WorldFromBody(double time) const {
  return WorldFromLeft(time) * Inverse(*calibration_.body_from_left);
}

Trajectory SyntheticSequence::GroundTruth(int per_frame) const {
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

ImuRecording SyntheticSequence::Imu() const {
  ImuModel model;
  model.rate_hz = options_.imu_rate_hz;
  model.faults = options_.imu;
  return RecordImu([this](double time) { return WorldFromBody(time); },
                   TimeOf(size() - 1),
                   model,
                   options_.imu_noise,
                   MixBits(options_.seed + kImuStream));
}

std::vector<TrueLine> SyntheticSequence::Lines(int threads) const {
  std::vector<TimedView> views;
  for (int frame = 0; frame < size(); ++frame) {
    views.push_back({TimeOf(frame), WorldFromLeft(TimeOf(frame))});
  }
  return TrueLines(made_.scene, calibration_.left, views, {}, threads);
}

Rendering SyntheticSequence::RenderIdeal(int frame, int camera) const {
  PLUMBLINE_CHECK(frame >= 0 && frame < size(), "frame of the sequence");
  PLUMBLINE_CHECK(camera == 0 || camera == 1, "camera of the pair");
  constexpr double kSecondsPerMs = 1e-3;
  const Shutter shutter{
      TimeOf(frame), kSecondsPerMs * options_.shutter_ms, kSecondsPerMs * options_.readout_ms};
  const Rigid3 left_from_camera = camera == 0 ? Rigid3{} : Inverse(calibration_.right_from_left);
  return renderer_.Render(
      camera == 0 ? left_rays_ : right_rays_,
      [&](double time) { return WorldFromLeft(time) * left_from_camera; },
      shutter);
}

// A camera's exposure control: it measures each image and brings the next one a part of the way to
// the desired brightness.
std::vector<double> SyntheticSequence::FindGains(int threads) const {
  constexpr double kProbeScale = 0.1, kTarget = 85, kPart = 0.25, kLeast = 0.1, kMost = 12;
  const RayTable probe(MakeCamera(options_, false, kProbeScale));
  const std::vector<double> means = ParallelMap<double>(size(), threads, [&](int frame) {
    return Mean(renderer_
                    .Render(probe,
                            [this](double time) { return WorldFromLeft(time); },
                            {TimeOf(frame), 0, 0})
                    .light);
  });
  const auto wanted = [=](double mean) {
    return std::clamp(kTarget / std::max(mean, 1e-3), kLeast, kMost);
  };
  std::vector<double> gains;
  double gain = wanted(means.front());
  for (const double mean : means) {
    gains.push_back(gain);
    gain *= math::Pow(wanted(mean) / gain, kPart);
  }
  return gains;
}

GrayImage SyntheticSequence::Sense(const Image<float>& light, int frame, int camera) const {
  const double control = gains_.empty() ? 1 : gains_[static_cast<std::size_t>(frame)];
  const SensorModel model{options_.exposure * control,
                          options_.gamma,
                          options_.vignetting,
                          options_.noise,
                          options_.lens_blur};
  const std::uint64_t chip = HashCell(camera, 0, MixBits(options_.seed + kNoiseStream));
  const std::uint64_t stream = HashCell(frame, camera, MixBits(options_.seed + kNoiseStream));
  GrayImage image = Expose(light, model, chip, stream);
  if (options_.person) DrawPerson(CameraOf(camera), PersonIn(frame, camera), image);
  if (options_.text) DrawText(image);
  return image;
}

const Camera& SyntheticSequence::CameraOf(int camera) const {
  return camera == 0 ? calibration_.left : *calibration_.right;
}

Person SyntheticSequence::PersonIn(int frame, int camera) const {
  constexpr double kDistance = 2.5;  // metres
  const double disparity = calibration_.left.CentreFocal() * options_.baseline / kDistance;
  return {TimeOf(frame), camera == 0 ? 0 : disparity};
}

GrayImage SyntheticSequence::MaskOfPerson(int frame, int camera) const {
  return PersonMask(CameraOf(camera), PersonIn(frame, camera));
}

DepthImage SyntheticSequence::SenseDepthOf(const DepthImage& depth, int frame) const {
  return SenseDepth(
      depth, options_.depth_noise, HashCell(frame, 0, MixBits(options_.seed + kDepthStream)));
}

}  // namespace plumbline

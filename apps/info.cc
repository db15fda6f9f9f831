// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/counted.h"
#include "plumbline/base/error.h"
#include "plumbline/base/options.h"
#include "plumbline/base/printable.h"
#include "plumbline/base/units.h"
#include "plumbline/features/stereo_pair_check.h"
#include "plumbline/image/rectify.h"
#include "plumbline/inertial/inertial_check.h"
#include "plumbline/inertial/rate_alignment.h"
#include "plumbline/io/cameras/camera_file.h"
#include "plumbline/io/datasets/dataset.h"
#include "plumbline/io/datasets/open_dataset.h"
#include "plumbline/io/inertial/inertial_recording.h"
#include "plumbline/io/trajectory_io.h"
#include "plumbline/report/error_options.h"

#include "apps/command_inputs.h"
#include "apps/command_line.h"
#include "apps/commands.h"
#include <algorithm>
#include <iostream>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include <fmt/core.h>
#include <fmt/ranges.h>

namespace plumbline {
namespace {

CommandSyntax InfoSyntax() {
  return {
      "info",
      "Tells what is at a path: format, sensors, frames, rate, calibration, what is missing.",
      {"PATH"},
      {{"--sensor", "mono|stereo|rgbd", "look at the data as for this sensor (richest)"},
       {"--format",
        "auto|euroc|tum|kitti|images|video|bag|mcap|rosbag2",
        "how the data is stored (auto)"},
       {"--topic", "NAME", "images, or samples, of a bag or an MCAP file; may be repeated"},
       {"--camera", "FILE", "camera file or name of a built-in camera"},
       {"--imu", "FILE|off|auto", "calibration of the inertial sensor; auto: with the data (auto)"},
       {"--ground-truth", "FILE|none", "poses to look at in place of those with the data"},
       {"--rotate", "auto|none|90|180|270", kRotateHelp},
       {"--max-width", "PIXELS", kMaxWidthHelp},
       {"--view-angle", "DEGREES", kViewAngleHelp},
       {"--mask",
        "FILE|TOPIC",
        "black is not used: tells the share; may be repeated (left, right)"},
       {"--check", "", "decode every image and name those that cannot be used"}}};
}

void Row(const std::string& name, const std::string& text) {
  std::cout << fmt::format("{:<13} {}\n", name, Printable(text, kLongestMessage));
}

void PrintTimes(const DatasetInfo& info) {
  constexpr double kNanoseconds = 1e9;
  const std::vector<std::int64_t>& stamps = info.stamps_ns;
  Row("frames", std::to_string(stamps.size()));
  Row("time", FormatStamp(stamps.front()) + " to " + FormatStamp(stamps.back()) + " s");
  std::vector<std::int64_t> intervals;
  for (std::size_t i = 1; i < stamps.size(); ++i) intervals.push_back(stamps[i] - stamps[i - 1]);
  std::string rate;
  if (!intervals.empty()) {
    std::sort(intervals.begin(), intervals.end());
    const std::int64_t median = intervals[intervals.size() / 2];
    rate = fmt::format("{:.4g} Hz", kNanoseconds / static_cast<double>(median));
    const auto gaps = std::count_if(intervals.begin(), intervals.end(), [&](std::int64_t d) {
      return d > median + median / 2;
    });
    if (gaps > 0) {
      rate += fmt::format("; {} above 1.5 intervals, the longest {:.3f} s",
                          Counted(gaps, "gap"),
                          static_cast<double>(intervals.back()) / kNanoseconds);
    }
  }
  if (info.calibration.rate_hz) {
    rate += fmt::format("{}nominal {:.4g} Hz", rate.empty() ? "" : "; ", *info.calibration.rate_hz);
  }
  if (!rate.empty()) Row("rate", rate);
}

std::string Describe(const Camera& camera, bool rectified) {
  const CameraIntrinsics& k = camera.intrinsics();
  std::string model = rectified ? "rectified" : "no distortion";
  if (k.model != DistortionModel::kNone) model = fmt::format("{} distortion", FormOf(k.model).name);
  return fmt::format("{}x{}, fx {:.6g} fy {:.6g} cx {:.6g} cy {:.6g}, {}",
                     k.width,
                     k.height,
                     k.fx,
                     k.fy,
                     k.cx,
                     k.cy,
                     model);
}

void PrintCalibration(const DatasetInfo& info) {
  const Calibration& c = info.calibration;
  if (!info.has_calibration) {
    Row("camera",
        fmt::format(
            "missing: give --camera FILE or one of {}, or put a camera.yaml into the folder",
            fmt::join(BuiltInCameras(), ", ")));
    return;
  }
  Row("calibration", info.calibration_source);
  Row("camera", Describe(c.left, c.rectified));
  if (c.right) {
    Row("right camera", Describe(*c.right, c.rectified));
    Row("baseline", fmt::format("{:.4f} m", c.right_from_left.translation.norm()));
  }
  const Rectifier rectifier(c);
  if (!rectifier.PassesUnchanged()) Row("used view", ViewText(rectifier));
  if (c.depth_factor) Row("depth", fmt::format("{:g} per metre", *c.depth_factor));
}

void PrintGroundTruth(const DatasetInfo& info) {
  if (!info.ground_truth) {
    const auto& fault = info.ground_truth_fault;
    Row("ground truth", fault ? "cannot be used: " + *fault : "none");
    return;
  }
  const std::int64_t max_gap_ns = ErrorOptionsFor(info.sensor, info.format).max_gap_ns;
  const GroundTruth& truth = *info.ground_truth;
  const auto covered =
      std::count_if(info.stamps_ns.begin(), info.stamps_ns.end(), [&](std::int64_t stamp) {
        return InterpolateAt(truth.poses, stamp, max_gap_ns).has_value();
      });
  const bool body = truth.frame == GroundTruth::Frame::kBody;
  Row("ground truth",
      fmt::format("{} poses of the {}, at {} of {} frames; {}",
                  truth.poses.size(),
                  body ? "body" : "camera",
                  covered,
                  info.stamps_ns.size(),
                  truth.path.string()));
}

std::string Describe(const InertialCalibration& calibration, const std::string& source) {
  std::vector<std::string> known, missing;
  (calibration.imu_from_left ? known : missing).emplace_back("place");
  (calibration.noise ? known : missing).emplace_back("noise");
  std::string text = source.empty() ? "none" : source;
  if (!known.empty()) text += fmt::format(": {}", fmt::join(known, ", "));
  if (calibration.imu_from_left) {
    text += fmt::format("; {:.3f} m from the left camera",
                        calibration.imu_from_left->translation.norm());
  }
  if (calibration.time_offset) {
    text += fmt::format("; clock {:+.4g} s from the camera's", *calibration.time_offset);
  }
  if (!missing.empty()) text += fmt::format("; missing: {}", fmt::join(missing, ", "));
  return text;
}

void PrintInertial(const InertialRecording& recording) {
  const InertialCheck check = CheckInertial(recording.ordered, recording.calibration);
  Row("imu",
      fmt::format("{} samples in {:.3f} s, {:.4g} Hz, jitter {:.2g} ms; {}",
                  check.samples,
                  check.seconds,
                  check.rate_hz,
                  1e3 * check.jitter,
                  recording.source));
  Row("imu file", Describe(recording.calibration, recording.calibration_source));
  if (check.rest_seconds == 0) {
    Row("imu at rest", "no rest found");
  } else {
    Row("imu at rest",
        fmt::format("{:g} s: gyroscope {:.3g} rad/s/sqrt(Hz), bias {:.3g} rad/s; accelerometer "
                    "{:.3g} m/s^2/sqrt(Hz)",
                    check.rest_seconds,
                    check.gyroscope_noise_density,
                    check.gyroscope_bias.norm(),
                    check.accelerometer_noise_density));
  }
  for (const std::string& note : recording.notes) Row("note", note);
  for (const std::string& fault : InertialFaults(check, recording.calibration)) {
    Row("imu fault", fault);
  }
}

// Compares place and clock of the sensor with the turns of ground truth.
void PrintAlignment(const DatasetInfo& info, const InertialRecording& recording) {
  if (!info.ground_truth || !info.has_calibration) return;
  const Trajectory camera = info.ground_truth->OfCamera(info.calibration);
  const auto alignment = AlignRates(camera, recording.ordered.samples);
  if (!alignment) {
    Row("imu to camera", "not known: the turns of poses and samples do not tell");
    return;
  }
  const Eigen::Vector3d& bias = alignment->gyroscope_bias;
  Row("imu to camera",
      fmt::format("measured by poses and samples: rotation to {:.2g} degrees, clock {:+.2f} ms "
                  "(+-{:.2g}), gyroscope's bias "
                  "{:.3g} rad/s; by {} stretches of {}",
                  alignment->rotation_sigma / kDegree,
                  1e3 * alignment->time_offset,
                  1e3 * alignment->time_offset_sigma,
                  bias.norm(),
                  alignment->intervals,
                  info.ground_truth->path.string()));
  for (const std::string& fault : AlignmentFaults(*alignment, recording.calibration)) {
    Row("imu fault", fault);
  }
}

// Tells of the samples beside images. Those that cannot be read are a row, unless `wanted`: images
// are of use without them.
void PrintInertialOf(const DatasetInfo& info, const InertialOptions& options, Rotation rotation) {
  const bool wanted = options.imu.has_value();
  std::optional<InertialRecording> recording;
  try {
    recording = FindInertial(info.path, info.format, options);
  } catch (const InputError& error) {
    if (wanted) throw;
    Row("imu", std::string("cannot be used: ") + error.what());
    return;
  }
  if (recording) {
    PrintInertial(*recording);
    // The file of a sensor tells its place at the camera as delivered.
    const bool as_delivered = rotation == Rotation::kAuto || rotation == Rotation::kNone;
    if (as_delivered) PrintAlignment(info, *recording);
  }
  if (!recording && wanted) {
    throw InputError(info.path.string() + ": expected samples of an inertial sensor, found none");
  }
}

// Returns the fault of an unusable frame; nullopt if it is usable.
std::optional<std::string> FaultOf(const Dataset& dataset, std::size_t i) {
  const Expected<SensorFrame, ImageFailure> frame = dataset.Read(i);
  if (frame) return std::nullopt;
  return frame.error().path.string() + ": " + frame.error().why;
}

void CheckImages(const Dataset& dataset) {
  std::size_t bad = 0;
  for (std::size_t i = 0; i < dataset.size(); ++i) {
    const std::optional<std::string> fault = FaultOf(dataset, i);
    if (!fault) continue;
    ++bad;
    Row("bad image", fmt::format("frame {}: {}", i, *fault));
  }
  Row("checked", fmt::format("{} of {} frames can be used", dataset.size() - bad, dataset.size()));
}

// Returns the inconsistency between the first stereo pairs and the calibration, if any. Unreadable
// frames are left out.
std::optional<std::string> PairFaultOf(const Dataset& dataset) {
  if (!dataset.info().has_calibration || !dataset.calibration().right) return std::nullopt;
  const Rectifier rectifier(dataset.calibration());
  StereoPairCheck check(rectifier);
  for (std::size_t i = 0; i < dataset.size(); ++i) {
    if (!StereoPairCheck::LooksAt(i)) continue;
    const Expected<SensorFrame, ImageFailure> frame = dataset.Read(i);
    if (!frame) continue;
    if (const auto fault = check.Add(i, *frame)) return Describe(*fault);
  }
  return std::nullopt;
}

}  // namespace

int InfoCommand(std::span<const std::string> arguments) {
  const CommandLine line(InfoSyntax(), arguments);
  if (line.help()) {
    std::cout << HelpText(InfoSyntax());
    return 0;
  }
  DatasetOptions options;
  options.allow_missing_camera = true;
  options.camera = line.Value("--camera");
  options.ground_truth = line.Value("--ground-truth");
  options.topics = line.Values("--topic");
  options.rotate = ReadRotation(line);
  options.max_width = ReadMaxWidth(line);
  options.view_angle_deg = ReadViewAngle(line);
  options.masks = line.Values("--mask");
  if (const auto text = line.Value("--sensor")) {
    options.sensor = ParseChoice<SensorKind>("--sensor", *text);
  }
  if (const auto text = line.Value("--format"); text && *text != "auto") {
    options.format = ParseChoice<DatasetFormat>("--format", *text);
  }
  const std::string imu = line.Value("--imu").value_or("auto");
  InertialOptions inertial{std::nullopt, options.camera, options.topics};
  if (imu != "auto" && imu != "off") inertial.imu = imu;
  if (imu != "off" && IsInertialAlone(line.Positional(0))) {
    PrintInertial(OpenInertialAlone(line.Positional(0), inertial));
    return 0;
  }
  const std::unique_ptr<Dataset> dataset = OpenDataset(line.Positional(0), options);
  const DatasetInfo& info = dataset->info();
  Row("name", info.name);
  Row("format", NameOf(info.format) + (info.layout.empty() ? "" : ", " + info.layout));
  std::vector<std::string> sensors;
  for (const SensorKind kind : info.available) sensors.push_back(NameOf(kind));
  Row("sensors", fmt::format("{} (shown: {})", fmt::join(sensors, ", "), NameOf(info.sensor)));
  PrintTimes(info);
  PrintCalibration(info);
  PrintGroundTruth(info);
  if (imu != "off") PrintInertialOf(info, inertial, options.rotate);
  for (const std::string& note : info.notes) Row("note", note);
  if (const auto fault = PairFaultOf(*dataset)) Row("note", *fault);
  if (line.Has("--check")) CheckImages(*dataset);
  return 0;
}

}  // namespace plumbline

// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/parallel.h"
#include "plumbline/io/atomic_file.h"
#include "plumbline/io/cameras/camera_file.h"
#include "plumbline/io/export/png.h"
#include "plumbline/io/inertial/inertial_calibration_file.h"
#include "worlds/overlay.h"
#include "worlds/sequence_formats.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <sstream>
#include <string>
#include <vector>

namespace plumbline {
namespace {

namespace fs = std::filesystem;

constexpr double kDepthFactor = 5000;

std::string ImageName(const SyntheticSequence& sequence, int frame) {
  return std::to_string(sequence.StampNs(frame)) + ".png";
}

std::string SensorYaml(const SyntheticSequence& sequence, int camera) {
  const Calibration& calibration = sequence.calibration();
  const bool left = camera == 0;
  const CameraIntrinsics& k = (left ? calibration.left : *calibration.right).intrinsics();
  const Rigid3 body_from_camera =
      left ? *calibration.body_from_left
           : *calibration.body_from_left * Inverse(calibration.right_from_left);
  const Eigen::Matrix4d matrix = body_from_camera.Matrix();
  std::ostringstream text = TextStream(16);
  text << "# Rendered by Plumbline.\nsensor_type: camera\ncomment: synthetic cam" << camera
       << "\n\n# Camera in the body frame (body_from_camera).\nT_BS:\n  cols: 4\n  rows: 4\n  "
          "data: [";
  for (int i = 0; i < 16; ++i) text << matrix(i / 4, i % 4) << (i < 15 ? ", " : "]\n\n");
  text << "rate_hz: " << *calibration.rate_hz << "\nresolution: [" << k.width << ", " << k.height
       << "]\ncamera_model: pinhole\nintrinsics: [" << k.fx << ", " << k.fy << ", " << k.cx << ", "
       << k.cy << "]  # fu, fv, cu, cv\ndistortion_model: radial-tangential\n"
       << "distortion_coefficients: [" << k.distortion[0] << ", " << k.distortion[1] << ", "
       << k.distortion[2] << ", " << k.distortion[3] << "]\n";
  return text.str();
}

std::string ImageList(const SyntheticSequence& sequence) {
  std::string text = "#timestamp [ns],filename\n";
  for (int i = 0; i < sequence.size(); ++i) {
    text += std::to_string(sequence.StampNs(i)) + "," + ImageName(sequence, i) + "\n";
  }
  return text;
}

// The bias of the inertial sensor at a time, the last sample's before it.
const ImuSample& BiasAt(const std::vector<ImuSample>& biases, double time, double rate_hz) {
  const double since_first = time - biases.front().time;
  const auto index = static_cast<std::size_t>(std::max(0.0, since_first * rate_hz + 1e-6));
  return biases[std::min(index, biases.size() - 1)];
}

// The 17 columns of EuRoC; velocities by central differences.
std::string GroundTruthCsv(const SyntheticSequence& sequence,
                           const std::vector<ImuSample>& biases) {
  constexpr double kRate = 200, kStep = 1e-4;
  const Calibration& calibration = sequence.calibration();
  const Rigid3 left_from_body = Inverse(*calibration.body_from_left);
  const int per_frame = std::max(1, static_cast<int>(std::lround(kRate / *calibration.rate_hz)));
  std::ostringstream text = TextStream(12);
  text << "#timestamp [ns], p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], "
          "q_RS_y [], q_RS_z [], v_RS_R_x [m s^-1], v_RS_R_y [m s^-1], v_RS_R_z [m s^-1], "
          "b_w_RS_S_x [rad s^-1], b_w_RS_S_y [rad s^-1], b_w_RS_S_z [rad s^-1], "
          "b_a_RS_S_x [m s^-2], b_a_RS_S_y [m s^-2], b_a_RS_S_z [m s^-2]\n";
  for (const StampedPose& pose : sequence.GroundTruth(per_frame)) {
    const Rigid3 body = pose.world_from_camera * left_from_body;
    const double time = static_cast<double>(pose.stamp_ns - sequence.StampNs(0)) * 1e-9;
    const Eigen::Vector3d velocity = (sequence.WorldFromBody(time + kStep).translation -
                                      sequence.WorldFromBody(time - kStep).translation) /
                                     (2 * kStep);
    const ImuSample& bias = BiasAt(biases, time, sequence.options().imu_rate_hz);
    const Eigen::Vector3d &w = bias.angular_rate, &a = bias.specific_force;
    const Eigen::Vector3d& p = body.translation;
    const Eigen::Quaterniond& q = body.rotation;
    text << pose.stamp_ns << ',' << p.x() << ',' << p.y() << ',' << p.z() << ',' << q.w() << ','
         << q.x() << ',' << q.y() << ',' << q.z() << ',' << velocity.x() << ',' << velocity.y()
         << ',' << velocity.z() << ',' << w.x() << ',' << w.y() << ',' << w.z() << ',' << a.x()
         << ',' << a.y() << ',' << a.z() << '\n';
  }
  return text.str();
}

std::string ImuYaml(const SyntheticSequence& sequence) {
  const ImuModel model;
  std::ostringstream text = TextStream(9);
  text << "# Rendered by Plumbline; the body is the inertial sensor.\nsensor_type: imu\n"
          "comment: synthetic imu0\nT_BS:\n  cols: 4\n  rows: 4\n"
          "  data: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]\nrate_hz: "
       << sequence.options().imu_rate_hz << "\n\n# Densities of white noise and of the walk of the "
       << "biases; all times imu_noise = " << sequence.options().imu_noise << ".\n"
       << "gyroscope_noise_density: " << model.gyroscope_density
       << "\ngyroscope_random_walk: " << model.gyroscope_walk
       << "\naccelerometer_noise_density: " << model.accelerometer_density
       << "\naccelerometer_random_walk: " << model.accelerometer_walk << "\n";
  return text.str();
}

std::string DepthYaml(const SyntheticSequence& sequence) {
  const CameraIntrinsics& k = sequence.calibration().left.intrinsics();
  std::ostringstream text = TextStream(9);
  text
      << "# Rendered by Plumbline: depth along z of cam0's pixels, 16 bit, value / depth_factor in "
         "metres.\nsensor_type: depth\ncomment: registered to cam0\nrate_hz: "
      << *sequence.calibration().rate_hz << "\nresolution: [" << k.width << ", " << k.height
      << "]\ndepth_factor: " << kDepthFactor << "\n";
  return text.str();
}

}  // namespace

void WriteEurocFolder(const SyntheticSequence& sequence,
                      const fs::path& folder,
                      int threads,
                      const std::function<void(int)>& done) {
  const fs::path root = folder / "mav0";
  const fs::path cameras[2] = {root / "cam0", root / "cam1"};
  const fs::path depth = root / "depth0", imu = root / "imu0";
  const fs::path truth = root / "state_groundtruth_estimate0";
  for (const fs::path& camera : cameras) MakeFolder(camera / "data");
  MakeFolder(imu);
  MakeFolder(truth);
  if (sequence.options().depth) MakeFolder(depth / "data");
  const fs::path masks[2] = {folder / "mask0", folder / "mask1"};
  if (sequence.options().person) {
    for (const fs::path& mask : masks) MakeFolder(mask);
  }
  ParallelFor(sequence.size(), threads, [&](int frame) {
    const std::string name = ImageName(sequence, frame);
    for (int camera = 0; camera < 2; ++camera) {
      const Rendering ideal = sequence.RenderIdeal(frame, camera);
      WriteGrayPng(cameras[camera] / "data" / name, sequence.Sense(ideal.light, frame, camera));
      if (sequence.options().person) {
        WriteGrayPng(masks[camera] / name, sequence.MaskOfPerson(frame, camera));
      }
      if (camera == 0 && sequence.options().depth) {
        WriteDepthPng(
            depth / "data" / name, sequence.SenseDepthOf(ideal.depth, frame), kDepthFactor);
      }
    }
    done(frame);
  });
  const ImuRecording recording = sequence.Imu();
  WriteFileAtomically(imu / "sensor.yaml", ImuYaml(sequence));
  WriteFileAtomically(imu / "data_ideal.csv", ImuCsv(sequence, recording.ideal));
  WriteFileAtomically(imu / "data.csv", ImuCsv(sequence, recording.noisy));
  WriteFileAtomically(truth / "data.csv", GroundTruthCsv(sequence, recording.biases));
  if (sequence.options().depth) {
    WriteFileAtomically(depth / "sensor.yaml", DepthYaml(sequence));
    WriteFileAtomically(depth / "data.csv", ImageList(sequence));
  }
  const Camera& left = sequence.calibration().left;
  if (sequence.options().text) {
    WriteGrayPng(folder / "mask_text.png", TextMask(left.width(), left.height()));
  }
  if (HasOtherLens(sequence.options())) {
    WriteFileAtomically(
        folder / "camera.yaml",
        FormatCamera(sequence.calibration()) + FormatInertialCalibration(InertialOf(sequence)));
  }
  for (int camera = 0; camera < 2; ++camera) {
    if (!HasOtherLens(sequence.options())) {
      WriteFileAtomically(cameras[camera] / "sensor.yaml", SensorYaml(sequence, camera));
    }
    WriteFileAtomically(cameras[camera] / "data.csv", ImageList(sequence));
  }
}

}  // namespace plumbline

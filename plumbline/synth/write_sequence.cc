// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/options_io.h"
#include "plumbline/base/parallel.h"
#include "plumbline/io/atomic_file.h"
#include "plumbline/io/png.h"
#include "plumbline/synth/sequence.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <locale>
#include <mutex>
#include <sstream>
#include <string>

namespace plumbline {
namespace {

std::ostringstream TextStream(int digits) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << std::setprecision(digits);
  return text;
}

std::string ImageName(const StereoSequence& sequence, int frame) {
  return std::to_string(sequence.StampNs(frame)) + ".png";
}

std::string SensorYaml(const StereoSequence& sequence, int camera) {
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

std::string ImageList(const StereoSequence& sequence) {
  std::string text = "#timestamp [ns],filename\n";
  for (int i = 0; i < sequence.size(); ++i) {
    text += std::to_string(sequence.StampNs(i)) + "," + ImageName(sequence, i) + "\n";
  }
  return text;
}

// The 17 columns of EuRoC; velocities by central differences, sensor biases zero.
std::string GroundTruthCsv(const StereoSequence& sequence) {
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
    const auto position = [&](double t) {
      return (sequence.WorldFromLeft(t) * left_from_body).translation;
    };
    const Eigen::Vector3d velocity =
        (position(time + kStep) - position(time - kStep)) / (2 * kStep);
    const Eigen::Vector3d& p = body.translation;
    const Eigen::Quaterniond& q = body.rotation;
    text << pose.stamp_ns << ',' << p.x() << ',' << p.y() << ',' << p.z() << ',' << q.w() << ','
         << q.x() << ',' << q.y() << ',' << q.z() << ',' << velocity.x() << ',' << velocity.y()
         << ',' << velocity.z() << ",0,0,0,0,0,0\n";
  }
  return text.str();
}

std::string LinesCsv(const Scene& scene) {
  std::ostringstream text = TextStream(9);
  text << "#x1 [m],y1 [m],z1 [m],x2 [m],y2 [m],z2 [m]\n";
  for (const Segment3& edge : scene.edges) {
    text << edge.start.x() << ',' << edge.start.y() << ',' << edge.start.z() << ',' << edge.end.x()
         << ',' << edge.end.y() << ',' << edge.end.z() << '\n';
  }
  return text.str();
}

std::string WorldYaml(const StereoSequence& sequence) {
  SynthOptions options = sequence.options();
  return "# Rendered by Plumbline; the same options give the same bytes again.\nworld: " +
         sequence.world() + "\n" + OptionTable(options).Dump();
}

}  // namespace

void WriteSequence(const StereoSequence& sequence,
                   const std::filesystem::path& folder,
                   int threads,
                   const std::function<void(int)>& progress) {
  const std::filesystem::path root = folder / "mav0";
  const std::filesystem::path cameras[2] = {root / "cam0", root / "cam1"};
  for (const auto& camera : cameras) MakeFolder(camera / "data");
  MakeFolder(root / "state_groundtruth_estimate0");
  std::mutex mutex;
  int done = 0;
  ParallelFor(sequence.size(), threads, [&](int frame) {
    for (int camera = 0; camera < 2; ++camera) {
      WriteGrayPng(cameras[camera] / "data" / ImageName(sequence, frame),
                   sequence.RenderImage(frame, camera));
    }
    const std::lock_guard lock(mutex);
    ++done;
    if (progress) progress(done);
  });
  // The lists come last: a folder with them is complete.
  WriteFileAtomically(root / "state_groundtruth_estimate0" / "data.csv", GroundTruthCsv(sequence));
  WriteFileAtomically(folder / "lines.csv", LinesCsv(sequence.scene()));
  WriteFileAtomically(folder / "world.yaml", WorldYaml(sequence));
  for (int camera = 0; camera < 2; ++camera) {
    WriteFileAtomically(cameras[camera] / "sensor.yaml", SensorYaml(sequence, camera));
    WriteFileAtomically(cameras[camera] / "data.csv", ImageList(sequence));
  }
}

}  // namespace plumbline

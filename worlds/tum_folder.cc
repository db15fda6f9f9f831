// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/parallel.h"
#include "plumbline/io/atomic_file.h"
#include "plumbline/io/export/png.h"
#include "plumbline/io/inertial/inertial_calibration_file.h"
#include "plumbline/io/trajectory_io.h"
#include "worlds/overlay.h"
#include "worlds/sequence_formats.h"

#include <cstddef>
#include <sstream>
#include <string>

namespace plumbline {
namespace {

namespace fs = std::filesystem;

constexpr double kDepthFactor = 5000;

std::string ImageName(const SyntheticSequence& sequence, int frame) {
  return FormatStamp(sequence.StampNs(frame)) + ".png";
}

std::string ImageList(const SyntheticSequence& sequence, const std::string& kind) {
  std::string text = "# " + kind + " images, rendered by Plumbline\n# timestamp filename\n#\n";
  for (int i = 0; i < sequence.size(); ++i) {
    const std::string name = ImageName(sequence, i);
    text += FormatStamp(sequence.StampNs(i)) + " " + kind + "/" + name + "\n";
  }
  return text;
}

std::string GroundTruthText(const SyntheticSequence& sequence) {
  constexpr int kPerFrame = 5;
  std::ostringstream text = TextStream(10);
  text << "# exact trajectory of the camera, rendered by Plumbline\n# timestamp tx ty tz qx qy qz "
          "qw\n#\n";
  for (const StampedPose& pose : sequence.GroundTruth(kPerFrame)) {
    const Eigen::Vector3d& p = pose.world_from_camera.translation;
    const Eigen::Quaterniond& q = pose.world_from_camera.rotation;
    text << FormatStamp(pose.stamp_ns) << ' ' << p.x() << ' ' << p.y() << ' ' << p.z() << ' '
         << q.x() << ' ' << q.y() << ' ' << q.z() << ' ' << q.w() << '\n';
  }
  return text.str();
}

std::string CameraYaml(const SyntheticSequence& sequence) {
  const Calibration& calibration = sequence.calibration();
  const CameraIntrinsics& k = calibration.left.intrinsics();
  const DistortionForm& form = FormOf(k.model);
  std::ostringstream text = TextStream(16);
  text << "# Rendered by Plumbline.\nmodel: pinhole\nsize: [" << k.width << ", " << k.height
       << "]\nintrinsics: [" << k.fx << ", " << k.fy << ", " << k.cx << ", " << k.cy
       << "]\ndistortion: " << form.name << '\n';
  for (std::size_t i = 0; i < form.most; ++i) {
    text << (i == 0 ? "distortion_coefficients: [" : ", ") << k.distortion[i];
  }
  if (form.most > 0) text << "]\n";
  text << "rate_hz: " << *calibration.rate_hz << "\ndepth_factor: " << kDepthFactor << '\n'
       << FormatInertialCalibration(InertialOf(sequence));
  return text.str();
}

}  // namespace

void WriteTumFolder(const SyntheticSequence& sequence,
                    const fs::path& folder,
                    int threads,
                    const std::function<void(int)>& done) {
  MakeFolder(folder / "rgb");
  MakeFolder(folder / "depth");
  if (sequence.options().person) MakeFolder(folder / "mask0");
  ParallelFor(sequence.size(), threads, [&](int frame) {
    const Rendering ideal = sequence.RenderIdeal(frame, 0);
    const std::string name = ImageName(sequence, frame);
    WriteGrayPng(folder / "rgb" / name, sequence.Sense(ideal.light, frame, 0));
    if (sequence.options().person) {
      WriteGrayPng(folder / "mask0" / name, sequence.MaskOfPerson(frame, 0));
    }
    WriteDepthPng(folder / "depth" / name, sequence.SenseDepthOf(ideal.depth, frame), kDepthFactor);
    done(frame);
  });
  const Camera& left = sequence.calibration().left;
  if (sequence.options().text) {
    WriteGrayPng(folder / "mask_text.png", TextMask(left.width(), left.height()));
  }
  const ImuRecording recording = sequence.Imu();
  WriteFileAtomically(folder / "imu_ideal.csv", ImuCsv(sequence, recording.ideal));
  WriteFileAtomically(folder / "imu.csv", ImuCsv(sequence, recording.noisy));
  WriteFileAtomically(folder / "groundtruth.txt", GroundTruthText(sequence));
  WriteFileAtomically(folder / "camera.yaml", CameraYaml(sequence));
  WriteFileAtomically(folder / "depth.txt", ImageList(sequence, "depth"));
  WriteFileAtomically(folder / "rgb.txt", ImageList(sequence, "rgb"));
}

}  // namespace plumbline

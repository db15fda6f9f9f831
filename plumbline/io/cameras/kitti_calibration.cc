// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/error.h"
#include "plumbline/geometry/calibration.h"
#include "plumbline/io/camera_formats.h"
#include "plumbline/io/text_rows.h"

#include <cmath>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/LU>
#include <fmt/core.h>

namespace plumbline {
namespace {

namespace fs = std::filesystem;
using Matrix34 = Eigen::Matrix<double, 3, 4>;
using RowMajor3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

// Numbers of a row of a calibration file.
struct CalibrationRow {
  std::vector<double> numbers;
  int line = 0;
};

// Returns the only row of this name; throws InputError if there is none, or if two differ.
TextRow OnlyRow(const fs::path& file, const std::string& name) {
  std::optional<TextRow> found;
  for (const TextRow& row : ReadRows(file, ' ')) {
    if (row.fields[0] != name) continue;
    if (found && found->fields != row.fields) {
      FailAt(file,
             row.line,
             fmt::format("one row '{}'", name),
             fmt::format("another one after that of line {}", found->line));
    }
    found = row;
  }
  if (found) return *found;
  throw InputError(fmt::format("{}: expected a row '{}', found none", file.string(), name));
}

// Reads a row `NAME: numbers`, of which there are `count`.
CalibrationRow ReadNumbers(const fs::path& file, const std::string& name, std::size_t count) {
  const TextRow row = OnlyRow(file, name + ":");
  if (row.fields.size() != count + 1) {
    FailAt(file,
           row.line,
           fmt::format("{} numbers after {}:", count, name),
           std::to_string(row.fields.size() - 1));
  }
  CalibrationRow read{{}, row.line};
  for (std::size_t i = 1; i <= count; ++i) read.numbers.push_back(NumberField(file, row, i));
  return read;
}

// Throws InputError at the line of the file if there is a fault (geometry/calibration.h).
void Refuse(const std::optional<std::string>& fault, const fs::path& file, int line) {
  if (fault) throw InputError(fmt::format("{}:{}: {}", file.string(), line, *fault));
}

// The projection of a rectified camera, K (I t).
struct RectifiedProjection {
  Matrix34 matrix;
  int line = 0;

  double fx() const { return matrix(0, 0); }
  double fy() const { return matrix(1, 1); }
  double cx() const { return matrix(0, 2); }
  double cy() const { return matrix(1, 2); }
  // t: translation of points from the frame of camera 0 to that of this camera.
  Eigen::Vector3d FromCamera0() const {
    return {(matrix(0, 3) - cx() * matrix(2, 3)) / fx(),
            (matrix(1, 3) - cy() * matrix(2, 3)) / fy(),
            matrix(2, 3)};
  }
};

RectifiedProjection ReadRectifiedProjection(const fs::path& file, const std::string& name) {
  const CalibrationRow row = ReadNumbers(file, name, 12);
  const RectifiedProjection read{
      Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(row.numbers.data()), row.line};
  const Matrix34& p = read.matrix;
  if (p(0, 0) <= 0 || p(1, 1) <= 0 || p(0, 1) != 0 || p(1, 0) != 0 ||
      p.row(2).head<3>() != Eigen::RowVector3d(0, 0, 1)) {
    FailAt(file, row.line, "the projection of a rectified camera", "another matrix");
  }
  return read;
}

Camera CheckedCamera(const CameraIntrinsics& k, const fs::path& file, int line) {
  Refuse(SizeFault(k.width, k.height), file, line);
  Refuse(IntrinsicsFault(k), file, line);
  Refuse(DistortionFault(k), file, line);
  return Camera(k);
}

Camera ToCamera(const RectifiedProjection& p, const fs::path& file, ImageSize size) {
  CameraIntrinsics k;
  k.fx = p.fx();
  k.fy = p.fy();
  k.cx = p.cx();
  k.cy = p.cy();
  k.width = size.width;
  k.height = size.height;
  return CheckedCamera(k, file, p.line);
}

// Throws if the right camera has another projection than the left one, or is not to its right.
void CheckPair(const fs::path& file,
               const RectifiedProjection& left,
               const RectifiedProjection& right,
               const std::string& what) {
  const double baseline = (left.FromCamera0() - right.FromCamera0()).x();
  const bool same = right.matrix.leftCols<3>() == left.matrix.leftCols<3>();
  if (baseline > 0 && same) return;
  const auto shown = [](const RectifiedProjection& p) {
    return fmt::format("fx {:g} fy {:g} cx {:g} cy {:g}", p.fx(), p.fy(), p.cx(), p.cy());
  };
  FailAt(file,
         right.line,
         what + " with a baseline above 0",
         same ? fmt::format("a baseline of {:g} m", baseline)
              : shown(right) + " beside " + shown(left));
}

// Reads the cameras from projections whose names have this before the number of the camera.
Calibration ReadProjections(const fs::path& file,
                            const std::string& prefix,
                            const KittiCameras& cameras,
                            ImageSize size) {
  const auto name = [&](int camera) { return prefix + std::to_string(camera); };
  const RectifiedProjection left = ReadRectifiedProjection(file, name(cameras.left));
  Calibration calibration;
  calibration.left = ToCamera(left, file, size);
  calibration.rectified = true;
  const Eigen::Vector3d place = -left.FromCamera0();
  if (!place.isZero(0)) {
    calibration.body_from_left = Rigid3{Eigen::Quaterniond::Identity(), place};
    Refuse(LeverFault(*calibration.body_from_left), file, left.line);
  }
  if (!cameras.right) return calibration;
  const RectifiedProjection right = ReadRectifiedProjection(file, name(*cameras.right));
  calibration.right = ToCamera(right, file, size);
  CheckPair(file, left, right, name(*cameras.right) + " to be " + name(cameras.left));
  const Eigen::Vector3d right_from_left = right.FromCamera0() - left.FromCamera0();
  calibration.right_from_left.translation = right_from_left;
  calibration.rectified = right_from_left.tail<2>().isZero(0);
  Refuse(PairFault(calibration), file, right.line);
  return calibration;
}

ImageSize ReadSize(const fs::path& file, const std::string& name) {
  const CalibrationRow row = ReadNumbers(file, name, 2);
  Refuse(SizeFault(row.numbers[0], row.numbers[1]), file, row.line);
  return {static_cast<int>(row.numbers[0]), static_cast<int>(row.numbers[1])};
}

Eigen::Quaterniond ReadRotation(const fs::path& file, const std::string& name) {
  const CalibrationRow row = ReadNumbers(file, name, 9);
  const Eigen::Matrix3d rotation = Eigen::Map<const RowMajor3>(row.numbers.data());
  const double off = (rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).norm();
  if (!(off <= 1e-3) || rotation.determinant() < 0) {
    FailAt(
        file, row.line, "a rotation matrix", fmt::format("R R^T off the identity by {:.3g}", off));
  }
  return Eigen::Quaterniond(rotation).normalized();
}

// A camera of a raw drive as it takes images.
struct RawCamera {
  Camera camera;
  Rigid3 from_camera0;
  int line = 0;  // of its place
};

RawCamera ReadRawCamera(const fs::path& file, int number) {
  const std::string suffix = fmt::format("_{:02}", number);
  const ImageSize size = ReadSize(file, "S" + suffix);
  const CalibrationRow k = ReadNumbers(file, "K" + suffix, 9);
  const CalibrationRow d = ReadNumbers(file, "D" + suffix, 5);
  const CalibrationRow t = ReadNumbers(file, "T" + suffix, 3);
  if (k.numbers[1] != 0 || k.numbers[3] != 0 || k.numbers[6] != 0 || k.numbers[7] != 0 ||
      k.numbers[8] != 1) {
    FailAt(file, k.line, "the matrix of a camera without skew", "another matrix");
  }
  CameraIntrinsics in;
  in.fx = k.numbers[0];
  in.fy = k.numbers[4];
  in.cx = k.numbers[2];
  in.cy = k.numbers[5];
  in.width = size.width;
  in.height = size.height;
  in.model = DistortionModel::kRadTan;
  std::copy(d.numbers.begin(), d.numbers.end(), in.distortion.begin());
  return {CheckedCamera(in, file, k.line),
          {ReadRotation(file, "R" + suffix), {t.numbers[0], t.numbers[1], t.numbers[2]}},
          t.line};
}

Calibration ReadAsTaken(const fs::path& file, const KittiCameras& cameras) {
  const RawCamera left = ReadRawCamera(file, cameras.left);
  Calibration calibration;
  calibration.left = left.camera;
  const Rigid3 rectified_from_camera0{ReadRotation(file, "R_rect_00"), Eigen::Vector3d::Zero()};
  calibration.body_from_left = rectified_from_camera0 * Inverse(left.from_camera0);
  Refuse(LeverFault(*calibration.body_from_left), file, left.line);
  if (!cameras.right) return calibration;
  const RawCamera right = ReadRawCamera(file, *cameras.right);
  calibration.right = right.camera;
  calibration.right_from_left = right.from_camera0 * Inverse(left.from_camera0);
  Refuse(PairFault(calibration), file, right.line);
  return calibration;
}

}  // namespace

Calibration ReadKittiCalibration(const fs::path& file,
                                 const KittiCameras& cameras,
                                 ImageSize size) {
  return ReadProjections(file, "P", cameras, size);
}

Calibration ReadKittiRawCalibration(const fs::path& file,
                                    const KittiCameras& cameras,
                                    ImageSize size,
                                    KittiImages otherwise,
                                    KittiImages* images) {
  const std::string suffix = fmt::format("_{:02}", cameras.left);
  const ImageSize rectified = ReadSize(file, "S_rect" + suffix);
  const ImageSize taken = ReadSize(file, "S" + suffix);
  if (size != rectified && size != taken) {
    throw InputError(
        fmt::format("{}: expected the size of the images, {}x{}, as S_rect{} or S{}, "
                    "found {}x{} and {}x{}",
                    file.string(),
                    size.width,
                    size.height,
                    suffix,
                    suffix,
                    rectified.width,
                    rectified.height,
                    taken.width,
                    taken.height));
  }
  KittiImages found = size == rectified ? KittiImages::kRectified : KittiImages::kAsTaken;
  if (rectified == taken) found = otherwise;
  if (images != nullptr) *images = found;
  return found == KittiImages::kRectified ? ReadProjections(file, "P_rect_0", cameras, size)
                                          : ReadAsTaken(file, cameras);
}

}  // namespace plumbline
